"""The vertices of person.npz by numpy and scipy alone: SCAPE's least squares, written out."""

import json

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.linalg import spsolve
from scipy.spatial.transform import Rotation

person = np.load("person.npz")
model = np.load(f"{json.loads(person['header'].tobytes())['gender']}.npz")  # of fitter/body/data
rest = model["mean_vertices"] + np.tensordot(person["shape"], model["shape_basis"], axes=1)

# The turns of all joints and their halves, and how each part is turned in the world.
turns = Rotation.from_rotvec(np.concatenate([person["pose"], person["pose"] / 2])).as_matrix()
turned = turns[:17].copy()
for part in range(1, 17):
    turned[part] = turned[model["part_parent"][part]] @ turned[part]

# Every edge is to be as at rest, turned with its part, as far as its neighbours let it.
matrix, wanted = 0, np.zeros_like(rest)
of_part = turned[model["part_of_triangle"]]
for corner in range(3):
    k, i, j = np.roll(model["triangles"], corner, axis=1).T
    a, b = (model["mean_vertices"][end] - model["mean_vertices"][k] for end in (i, j))
    w = model["triangle_weights"] * (a * b).sum(axis=1) / (np.cross(a, b) ** 2).sum(axis=1)
    edge = w[:, None] * np.einsum("tab,tb->ta", of_part, rest[i] - rest[j])
    np.add.at(wanted, i, edge)
    np.add.at(wanted, j, -edge)
    matrix += coo_array((np.r_[w, w, -w, -w], (np.r_[i, j, i, j], np.r_[i, j, j, i])))

# Flesh follows the joints around it, more on bodies of some shapes than on others.
joints = model["pose_feature_joints"]
bent = np.where(joints[..., None, None] < 0, 0, turns[joints] - np.eye(3)).reshape(17, -1)
bent *= 1 + model["pose_feature_strengths"] @ person["shape"]
part = np.repeat(np.arange(17), np.diff(model["incidence_pointers"]))
flesh = np.einsum("iab,ibf,if->ia", turned[part], model["pose_right_hand_sides"], bent[part])
np.add.at(wanted, model["incidence_vertices"], flesh)

# One vertex is held, then the pelvis' joint is put in its place: camera frame, y down, z away.
vertices = np.zeros_like(rest)
vertices[1:] = spsolve(matrix.tocsc()[1:, 1:], wanted[1:])
pelvis = slice(*model["joint_pointers"][:2])
joint = model["joint_weights"][pelvis] @ vertices[model["joint_indices"][pelvis]]
vertices = (vertices - joint) * [1, -1, -1] + person["translation"]
