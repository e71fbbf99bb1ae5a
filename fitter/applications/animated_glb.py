"""A moving body as glTF: exactly, by morph targets, or as a skin on bones.

Body frame's axes (y up), metres, the ground at y = 0; vertex order is the body model's. Where the
body is and which way it faces is animated on the node, so that the mesh itself stays in place.

Linear blending on bones is not SCAPE: a vertex is moved by a weighted mean of its bones' rigid
motions, v = Σ_b w_b M_b v_bind, without the flesh that follows a pose. Two things keep the
difference small: the body is bound in that pose of the motion that is most like all others, and the
bones go where the joints of the exact bodies are, which a raised shoulder takes along. Over a walk
0.9 mm are left on average and 13 in the worst vertex, over a dance 6 and 57; every skin's own are
measured. Bones are those of :mod:`fitter.applications.skeleton`.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Float32, Integer

from fitter.applications.motion import MovingBody
from fitter.applications.principal_frames import PrincipalFrames, with_rest
from fitter.applications.skeleton import Skeleton
from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.export.glb import BinaryChunk, Frame, Node, Target, gltf_document, pack_glb
from fitter.export.gltf_mesh import BODY_NODE, BodyTexture, add_body_mesh, unit_normals
from fitter.numerics.rotations import rotation_vectors
from fitter.parameters import Reflectance


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Skin:
    """A bound body.

    Attributes
    ----------
    skeleton
        Its bones.
    frame
        In whose pose it is bound.
    bones
        (t, b, 4, 4) where the bones are in every frame, of a rig in the first alone; root joint at
        the origin, pelvis not turned, metres.
    vertices
        (m, 3) the body in that pose, root joint at the origin, pelvis not turned, metres.
    inverse_bind
        (b, 4, 4) from there to the bones' own axes.
    parts, weights
        (m, 4) the bones a vertex follows, and how much; bone 0 where nothing.
    mean_error_m, largest_error_m
        Distance of vertices from exact SCAPE over all frames.
    """

    skeleton: Skeleton
    frame: int
    bones: Float[np.ndarray, "t b 4 4"]
    vertices: Vertices
    inverse_bind: Float[np.ndarray, "b 4 4"]
    parts: Integer[np.ndarray, "m 4"]
    weights: Float[np.ndarray, "m 4"]
    mean_error_m: float
    largest_error_m: float


def skin_of(body: MovingBody, model: BodyModel, skeleton: Skeleton) -> Skin:
    """Bind a moving body and measure what linear blending makes of its frames."""
    return _bound(body, model, skeleton, skeleton.of_body(body, model), most_typical(body))


def still_skin_of(body: MovingBody, model: BodyModel, skeleton: Skeleton) -> Skin:
    """Bind the first frame, and measure what bones that only turn make of the others."""
    bones = skeleton.of_body(body, model)
    _, offsets = skeleton.local(bones[:1])
    measured = _bound(body, model, skeleton, skeleton.only_turned(bones, offsets[0]), 0)
    return replace(measured, bones=bones[:1])


def _bound(
    body: MovingBody,
    model: BodyModel,
    skeleton: Skeleton,
    bones: Float[np.ndarray, "t b 4 4"],
    frame: int,
) -> Skin:
    weights = model.skinning_weights / model.skinning_weights.sum(axis=1, keepdims=True)
    parts = np.where(weights > 0.0, model.skinning_parts, 0)
    vertices = np.asarray(body.shapes[frame], dtype=np.float64)
    inverse_bind = np.linalg.inv(bones[frame])
    errors = [
        np.linalg.norm(blended(vertices, now @ inverse_bind, parts, weights) - exact, axis=1)
        for now, exact in zip(bones, body.shapes, strict=True)
    ]
    return Skin(
        skeleton=skeleton,
        frame=frame,
        bones=bones,
        vertices=vertices,
        inverse_bind=inverse_bind,
        parts=parts,
        weights=weights,
        mean_error_m=float(np.mean(errors)),
        largest_error_m=float(np.max(errors)),
    )


def most_typical(body: MovingBody) -> int:
    """The frame whose body is nearest to the mean of all."""
    mean = body.shapes.mean(axis=0)
    return int(np.argmin([np.square(shape - mean).sum() for shape in body.shapes]))


def blended(
    vertices: Vertices,
    motions: Float[np.ndarray, "p 4 4"],
    parts: Integer[np.ndarray, "m 4"],
    weights: Float[np.ndarray, "m 4"],
) -> Vertices:
    """Bound vertices moved by their bones."""
    matrices = np.einsum("mb,mbij->mij", weights, motions[parts][:, :, :3])
    return np.einsum("mij,mj->mi", matrices[:, :, :3], vertices) + matrices[:, :, 3]


def morphed_glb(
    body: MovingBody,
    frames: PrincipalFrames,
    model: BodyModel,
    *,
    reflectance: Reflectance | None,
    albedo_rgb: Vertices | None,
    texture: BodyTexture | None = None,
) -> bytes:
    """Exact SCAPE bodies as one mesh with morph targets, every frame with weights of its own."""
    document = gltf_document(
        [BODY_NODE | _placement(body)],
        model,
        name="body_animated",
        frame=Frame.ON_THE_GROUND,
        extras={
            "method": "exact SCAPE bodies in a basis of morph targets",
            "morph_targets": len(frames.targets),
            "largest_error_mm": 1e3 * frames.largest_error_m,
            "mean_error_mm": 1e3 * frames.mean_error_m,
        },
    )
    binary = BinaryChunk()
    primitive = add_body_mesh(
        document,
        binary,
        vertices=frames.base.astype(np.float64),
        triangles=model.triangles,
        reflectance=reflectance,
        albedo_rgb=albedo_rgb,
        texture=texture,
    )
    owners = slice(None) if texture is None else texture.owners
    primitive["targets"] = [
        {
            "POSITION": binary.add(target[owners], target=Target.VERTEX_ATTRIBUTE, bounds=True),
            "NORMAL": binary.add(normals[owners], target=Target.VERTEX_ATTRIBUTE),
        }
        for target, normals in zip(
            frames.targets, _normal_targets(body, frames, model), strict=True
        )
    ]
    document["meshes"][0]["weights"] = frames.weights[0].tolist()
    animation = _Animation(binary, body)
    animation.place(0)
    animation.sampled(0, "weights", frames.weights.ravel())
    document["animations"] = [animation.document("motion")]
    return pack_glb(document, binary)


_FIRST_BONE = 1
"""Node 0 is the mesh, the bones follow: a skinned mesh below another node is not moved by it."""


def skinned_glb(
    body: MovingBody,
    skin: Skin,
    model: BodyModel,
    *,
    reflectance: Reflectance | None,
    albedo_rgb: Vertices | None,
    texture: BodyTexture | None = None,
) -> bytes:
    """The body as a skin on its bones, for programs that go on animating: approximate.

    Of a skin with the bones of one frame alone it is a rig, which stands still.
    """
    document = gltf_document(
        [BODY_NODE | {"skin": 0}, *_bone_nodes(body, skin)],
        model,
        name="body_skinned",
        frame=Frame.ON_THE_GROUND,
        extras={
            "method": f"linear blending on {len(skin.bones[0])} bones: approximate, not SCAPE",
            "bound_in_frame": skin.frame,
            "largest_error_mm": 1e3 * skin.largest_error_m,
            "mean_error_mm": 1e3 * skin.mean_error_m,
        },
    )
    binary = BinaryChunk()
    # Bound where it stands in that frame, so that readers without skins show it on the ground.
    placement = np.eye(4)
    placement[:3, :3] = body.rotations[skin.frame]
    placement[:3, 3] = body.roots[skin.frame]
    inverse_bind = skin.inverse_bind @ np.linalg.inv(placement)
    primitive = add_body_mesh(
        document,
        binary,
        vertices=skin.vertices @ placement[:3, :3].T + placement[:3, 3],
        triangles=model.triangles,
        reflectance=reflectance,
        albedo_rgb=albedo_rgb,
        texture=texture,
    )
    attributes = primitive["attributes"]
    assert isinstance(attributes, dict)
    owners = slice(None) if texture is None else texture.owners
    attributes["JOINTS_0"] = binary.add(
        skin.parts[owners].astype(np.uint16), target=Target.VERTEX_ATTRIBUTE
    )
    attributes["WEIGHTS_0"] = binary.add(
        skin.weights[owners].astype(np.float32), target=Target.VERTEX_ATTRIBUTE
    )
    matrices = inverse_bind.transpose(0, 2, 1).reshape(-1, 16).astype(np.float32)
    document["skins"] = [
        {
            "name": "body",
            "joints": [_FIRST_BONE + bone for bone in range(len(matrices))],
            "skeleton": _FIRST_BONE,
            "inverseBindMatrices": binary.add(matrices, target=None),
        }
    ]
    if len(skin.bones) > 1:
        turns, offsets = skin.skeleton.local(skin.bones)
        animation = _Animation(binary, body)
        animation.place(_FIRST_BONE)
        for bone in range(1, len(skin.skeleton.names)):
            animation.sampled(_FIRST_BONE + bone, "translation", offsets[:, bone])
            animation.rotated(_FIRST_BONE + bone, rotation_vectors(turns[:, bone]))
        document["animations"] = [animation.document("motion")]
    return pack_glb(document, binary)


class _Animation:
    """Channels of one animation while they grow, on one accessor of times."""

    def __init__(self, binary: BinaryChunk, body: MovingBody) -> None:
        self._binary = binary
        self._body = body
        times = np.arange(len(body.shapes)) * body.motion.frame_time_s
        self._times = binary.add(times.astype(np.float32), target=None, bounds=True)
        self._samplers: list[dict[str, object]] = []
        self._channels: list[dict[str, object]] = []

    def sampled(self, node: int, path: str, values: np.ndarray) -> None:
        """A path of a node that is linear between frames."""
        output = self._binary.add(values.astype(np.float32), target=None)
        self._channels.append(
            {"sampler": len(self._samplers), "target": {"node": node, "path": path}}
        )
        self._samplers.append({"input": self._times, "output": output, "interpolation": "LINEAR"})

    def rotated(self, node: int, vectors: Float[np.ndarray, "t 3"]) -> None:
        """Rotation of a node."""
        self.sampled(node, "rotation", quaternions(vectors))

    def place(self, node: int) -> None:
        """Position and rotation of the whole body."""
        self.sampled(node, "translation", self._body.roots)
        self.rotated(node, self._body.motion.poses[:, 0])

    def document(self, name: str) -> dict[str, object]:
        """The animation as glTF has it."""
        return {"name": name, "samplers": self._samplers, "channels": self._channels}


def quaternions(vectors: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, "t 4"]:
    """Unit quaternions (x, y, z, w) of rotation vectors, each on the side of the one before.

    A quaternion and its negative are the same rotation, but interpolation between them is not.
    """
    angles = np.linalg.norm(vectors, axis=1, keepdims=True)
    axes = vectors / np.where(angles > 0.0, angles, 1.0)
    result = np.concatenate([axes * np.sin(0.5 * angles), np.cos(0.5 * angles)], axis=1)
    agree = np.einsum("ti,ti->t", result[1:], result[:-1]) >= 0.0
    result[1:] *= np.cumprod(np.where(agree, 1.0, -1.0))[:, None]
    return result


def _normal_targets(
    body: MovingBody, frames: PrincipalFrames, model: BodyModel
) -> Float32[np.ndarray, "k m 3"]:
    """Changes of the normals that come nearest to the true ones over all frames."""
    base = unit_normals(frames.base.astype(np.float64), model.triangles)
    # Least squares, normal by normal: pinv(W) (N_t - N_0) with W the changes of the weights, summed
    # frame by frame to save memory. The last weight never changes.
    weights = frames.weights[:, :-1].astype(np.float64)
    inverse = np.linalg.pinv(weights - weights[0])
    targets = np.zeros((len(inverse), *base.shape))
    for frame, shape in enumerate(body.shapes):
        change = unit_normals(shape.astype(np.float64), model.triangles) - base
        for target, share in zip(targets, inverse[:, frame], strict=True):
            target += share * change
    return with_rest(targets, weights[0]).astype(np.float32)


def _bone_nodes(body: MovingBody, skin: Skin) -> list[Node]:
    """The bones in the first frame."""
    turns, offsets = skin.skeleton.local(skin.bones[:1])
    rotations = quaternions(rotation_vectors(turns[0]))
    nodes: list[Node] = []
    for bone, name in enumerate(skin.skeleton.names):
        node: Node = {"name": name}
        children = [_FIRST_BONE + child for child in skin.skeleton.children(bone)]
        if children:
            node["children"] = children
        if skin.skeleton.parents[bone] < 0:
            node |= _placement(body)
        else:
            node["translation"] = offsets[0, bone].tolist()
            node["rotation"] = rotations[bone].tolist()
        nodes.append(node)
    return nodes


def _placement(body: MovingBody) -> Node:
    """Position and rotation of the first frame."""
    return {
        "translation": body.roots[0].tolist(),
        "rotation": quaternions(body.motion.poses[:1, 0])[0].tolist(),
    }
