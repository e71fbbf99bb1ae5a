import pytest

from fitter.applications.motion_file import NEEDED, PARTS, REQUEST, joints_of_parts, plain_name
from fitter.errors import InvalidInputError
from tests.unit.applications.bodies import packaged

LIMBS = ("upper_arm", "forearm", "hand", "thigh", "shin", "foot")

FAMILIES = {
    "CMU": "Hips lowerback Chest Neck Head / LeftShoulder LeftElbow LeftWrist LeftHip LeftKnee "
    "LeftAnkle",
    "Mixamo": "mixamorig:Hips mixamorig:Spine mixamorig:Spine2 mixamorig:Neck mixamorig:Head / "
    "mixamorig:LeftArm mixamorig:LeftForeArm mixamorig:LeftHand mixamorig:LeftUpLeg "
    "mixamorig:LeftLeg mixamorig:LeftFoot",
    "Biovision": "Hips Abdomen Chest Neck Head / LeftUpArm LeftLowArm LeftHand LeftUpLeg "
    "LeftLowLeg LeftFoot",
    "Rokoko": "Hip Spine Spine4 Neck Head / LeftArm LeftForeArm LeftHand LeftThigh LeftShin "
    "LeftFoot",
    "Poser, DAZ and MocapNET": "hip abdomen chest neck head / lShldr lForeArm lHand lThigh lShin "
    "lFoot",
    "SMPL": "Pelvis Spine1 Spine3 Neck Head / L_Shoulder L_Elbow L_Wrist L_Hip L_Knee L_Ankle",
    "Unreal": "pelvis spine_01 spine_03 neck_01 head / upperarm_l lowerarm_l hand_l thigh_l calf_l "
    "foot_l",
    "3ds Max Biped": "Bip001_Pelvis Bip001_Spine Bip001_Spine2 Bip001_Neck Bip001_Head / "
    "Bip001_L_UpperArm Bip001_L_Forearm Bip001_L_Hand Bip001_L_Thigh Bip001_L_Calf Bip001_L_Foot",
    "VRM and VRoid": "J_Bip_C_Hips J_Bip_C_Spine J_Bip_C_UpperChest J_Bip_C_Neck J_Bip_C_Head / "
    "J_Bip_L_UpperArm J_Bip_L_LowerArm J_Bip_L_Hand J_Bip_L_UpperLeg J_Bip_L_LowerLeg J_Bip_L_Foot",
    "Bandai-Namco": "Hips Spine Chest Neck Head / UpperArm_L LowerArm_L Hand_L UpperLeg_L "
    "LowerLeg_L Foot_L",
    "Blender Rigify": "DEF-spine DEF-spine.001 DEF-spine.003 DEF-spine.004 DEF-spine.006 / "
    "DEF-upper_arm.L DEF-forearm.L DEF-hand.L DEF-thigh.L DEF-shin.L DEF-foot.L",
    "Blender": "hips spine chest neck head / upper_arm.L forearm.L hand.L thigh.L shin.L foot.L",
    "Acclaim": "root lowerback thorax upperneck head / lhumerus lradius lhand lfemur ltibia lfoot",
    "OptiTrack": "Hip Ab Chest Neck Head / LUArm LFArm LHand LThigh LShin LFoot",
}
OTHERS = {
    "the first DAZ Genesis": (
        "Poser, DAZ and MocapNET",
        (
            "hip abdomenLower chestUpper neckLower head / lShldrTwist lForearmTwist lHand "
            "lThighTwist lShin lFoot"
        ),
    ),
    "SMPL-X": (
        "SMPL",
        (
            "pelvis spine1 spine3 neck head / left_shoulder left_elbow left_wrist left_hip "
            "left_knee left_ankle"
        ),
    ),
    "Unity": (
        "VRM and VRoid",
        (
            "Hips Spine Chest Neck Head / LeftUpperArm LeftLowerArm LeftHand LeftUpperLeg "
            "LeftLowerLeg LeftFoot"
        ),
    ),
    "LAFAN1": (
        "Mixamo",
        "Hips Spine Spine2 Neck Head / LeftArm LeftForeArm LeftHand LeftUpLeg LeftLeg LeftFoot",
    ),
    "Biped with blanks": (
        "3ds Max Biped",
        (
            "Bip01~Pelvis Bip01~Spine Bip01~Spine1 Bip01~Neck Bip01~Head / Bip01~L~UpperArm "
            "Bip01~L~Forearm Bip01~L~Hand Bip01~L~Thigh Bip01~L~Calf Bip01~L~Foot"
        ),
    ),
}
RIGHT = (("Left", "Right"), ("left", "right"), ("_L_", "_R_"), ("~L~", "~R~"), (".L", ".R"))


def joints(line: str) -> dict[str, str]:
    """By part, from names of the trunk and the left limbs."""
    trunk, left = (half.split() for half in line.split(" / "))
    names: dict[str, str] = {}
    names.update(zip(("pelvis", "spine", "chest", "neck", "head"), trunk, strict=True))
    for limb, name in zip(LIMBS, left, strict=True):
        names[f"left_{limb}"] = name.replace("~", " ")
        names[f"right_{limb}"] = right(name).replace("~", " ")
    return {part: name.replace("~", " ") for part, name in names.items()}


def right(name: str) -> str:
    for ours, theirs in RIGHT:
        if ours in name:
            return name.replace(ours, theirs)
    if name.lower().endswith("_l"):
        return name[:-1] + ("R" if name[-1] == "L" else "r")
    return ("R" if name[0] == "L" else "r") + name[1:]


@pytest.mark.parametrize(
    ("family", "line"),
    [*FAMILIES.items(), *OTHERS.values()],
    ids=[*FAMILIES, *OTHERS],
)
def test_a_skeleton_is_known_by_the_names_of_its_program(family, line):
    names = joints(line)
    order = sorted(names.values())
    naming, found = joints_of_parts(order)
    assert naming == family
    assert {part: order[joint] for part, joint in found.items()} == names


def test_the_parts_are_those_of_the_body():
    assert set(PARTS) == set(packaged("female").model.part_names)


def test_names_are_read_without_namespace_prefix_case_and_punctuation():
    assert plain_name("Armature:mixamorig1:LeftUpLeg") == "leftupleg"
    assert plain_name("Character1_LeftHand") == plain_name("left.hand") == "lefthand"


OWN = {part: f"Teil {number}" for number, part in enumerate(NEEDED)}


def test_joints_that_are_told_need_no_known_names():
    names = list(OWN.values())
    naming, found = joints_of_parts(names, OWN)
    assert naming == REQUEST
    assert {part: names[joint] for part, joint in found.items()} == OWN


def test_joints_that_are_told_are_taken_before_those_that_are_known():
    names = joints(FAMILIES["Mixamo"])
    odd = [*(name for part, name in names.items() if part != "left_foot"), "Peg", "Twist"]
    naming, found = joints_of_parts(odd, {"left_foot": "Peg", "left_thigh": "Twist"})
    assert naming == "Mixamo"
    assert (odd[found["left_foot"]], odd[found["left_thigh"]]) == ("Peg", "Twist")
    assert odd[found["right_thigh"]] == names["right_thigh"]


def refusal(names, named=None) -> InvalidInputError:
    with pytest.raises(InvalidInputError) as caught:
        joints_of_parts(names, named)
    return caught.value


@pytest.mark.parametrize("part", ["pelvis", "left_thigh"])
def test_a_skeleton_without_hips_or_legs_is_refused_by_what_it_lacks(part):
    names = joints(FAMILIES["Mixamo"]) | {part: "Peg"}
    error = refusal(list(names.values()))
    assert (error.code, error.field) == ("bvh-skeleton-unknown", "bvh")
    assert f"almost as by Mixamo, but none is the person's {part}." in error.reason
    assert "Peg" in error.reason
    assert f'`joints` which joint moves which part, such as {{"{part}"' in error.remedy
    assert all(family in error.remedy for family in FAMILIES)


def test_no_family_is_named_for_a_skeleton_that_is_like_none():
    error = refusal(["Hips", "Bein links", "Bein rechts", *(f"Glied {k}" for k in range(60))])
    assert not any(family in error.reason for family in FAMILIES)
    assert all(part in error.reason for part in NEEDED if part != "pelvis")
    assert "Glied 36 and 23 more" in error.reason


@pytest.mark.parametrize(
    ("named", "code", "told"),
    [
        ({"tail": "Teil 1"}, "part-unknown", "left_upper_arm"),
        ({"left_foot": "Peg"}, "bvh-skeleton-unknown", "Teil 12"),
    ],
)
def test_what_is_told_is_of_the_body_and_of_the_file(named, code, told):
    error = refusal(list(OWN.values()), OWN | named)
    assert (error.code, error.field) == (code, f"joints.{next(iter(named))}")
    assert told in error.reason + error.remedy
