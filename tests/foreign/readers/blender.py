"""Run by Blender's Python: import GLB files as a user does, and print what came in as JSON lines.

Blender's axes: the file's (x, y, z) is (x, -z, y) there, metres.
"""

import json
import sys

import bpy


def seen(file: str) -> dict[str, object]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file, disable_bone_shape=True)
    scene = bpy.context.scene
    kinds = [each.type for each in scene.objects]
    (body,) = [each for each in scene.objects if each.type == "MESH"]
    return {
        "vertices": len(body.data.vertices),
        "triangles": len(body.data.polygons),
        "cameras": kinds.count("CAMERA"),
        "lights": kinds.count("LIGHT"),
        "bones": sum(len(each.data.bones) for each in scene.objects if each.type == "ARMATURE"),
        "morph_targets": len(body.data.shape_keys.key_blocks) - 1 if body.data.shape_keys else 0,
        "textures": len(bpy.data.images),
        "extras": scene.get("frame", ""),
        "frames": [bounds(body, frame) for frame in shown_frames()],
    }


def shown_frames() -> list[float]:
    """The first, the middle and the last of the file's frames, in Blender's; one if nothing moves.

    In the middle of a walk the body is farthest from the first one, which is the base of its morph
    targets.
    """
    if not bpy.data.actions:
        return [0.0]
    channels = bpy.data.actions[0].layers[0].strips[0].channelbags[0].fcurves
    keys = [key.co[0] for key in channels[0].keyframe_points]
    return [keys[0], keys[(len(keys) - 1) // 2], keys[-1]]


def bounds(body: bpy.types.Object, frame: float) -> list[list[float]]:
    """Lowest and highest coordinates of the body in a frame, skin and morph targets applied.

    Blender plays 24 frames a second, so ours lie between its own.
    """
    bpy.context.scene.frame_set(int(frame), subframe=frame % 1.0)
    shown = body.evaluated_get(bpy.context.evaluated_depsgraph_get())
    places = [shown.matrix_world @ vertex.co for vertex in shown.to_mesh().vertices]
    return [[pick(place[i] for place in places) for i in range(3)] for pick in (min, max)]


for each in sys.argv[1:]:
    print("SEEN " + json.dumps(seen(each)))
