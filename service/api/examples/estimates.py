"""Examples of what needs no job: uploaded pictures, proposed points, initial poses, bodies."""

from typing import Any, Final

PICTURE_ID: Final = "0f7cfbdf3dcb0c9ac2e2b8f1f1c4f3a63f1a1b7f0e2a5d4c3b2a19080706f5e4"

UPLOADED_IMAGE: Final[dict[str, Any]] = {
    "id": PICTURE_ID,
    "media_type": "image/jpeg",
    "width": 720,
    "height": 960,
    "size": 153204,
    "focal_length_35mm": 50.0,
    "created_at": "2026-05-04T09:30:00Z",
    "expires_at": "2026-05-11T09:30:00Z",
}

POINTS: Final[dict[str, Any]] = {
    "left_shoulder": [438, 220],
    "right_shoulder": [251, 225],
    "left_elbow": [481, 341],
    "right_elbow": [178, 321],
    "left_wrist": [537, 461],
    "right_wrist": [229, 413],
    "left_hip": [390, 466],
    "right_hip": [301, 462],
    "left_knee": [408, 675],
    "right_knee": [295, 658],
    "left_ankle": [398, 822],
    "right_ankle": [296, 830],
}

INITIAL_POSE_REQUESTS: Final[dict[str, Any]] = {
    "size-alone": {
        "gender": "male",
        "height_m": 1.8,
        "points": POINTS,
        "image_size": {"width": 720, "height": 960},
    },
    "uploaded-picture": {
        "gender": "male",
        "measurements": {"stature": 180, "hip_girth": {"value": 98, "standard_error": 1.5}},
        "points": POINTS,
        "limb_facing": {"left_forearm": "toward"},
        "image_id": PICTURE_ID,
    },
}

INITIAL_POSE_ANSWER: Final[dict[str, Any]] = {
    "gender": "male",
    "height_m": 1.8,
    "camera": {
        "focal_length_px": 1386.64,
        "centre_x": 360.0,
        "centre_y": 480.0,
        "width": 720,
        "height": 960,
    },
    "focal_length_source": "assumed",
    "body": {
        "pose": [
            {"part": "pelvis", "rotation": [0.0496, 0.1583, -0.0406]},
            {"part": "spine", "rotation": [0.0247, 0.019, 0.053]},
        ],
        "translation_m": [-0.0283, -0.031, 2.959],
        "shape": [0.7601, 0.0, 0.0],
    },
    "outline": [[[341.12, 46.67], [339.81, 47.98], [333.23, 47.98], [322.72, 51.92]]],
    "points": {"left_shoulder": [436.2, 223.4], "right_shoulder": [250.3, 226.1]},
    "residual_px": {"left_shoulder": 3.8, "right_shoulder": 1.3},
    "limbs": [
        {"limb": "torso", "facing": "toward", "ambiguous": False, "alternative_nats": None},
        {"limb": "left_upper_arm", "facing": "away", "ambiguous": True, "alternative_nats": 0.49},
    ],
    "assumptions": [
        {
            "quantity": "focal_length_35mm",
            "value": 50.0,
            "reason": "Neither the request nor the picture's EXIF data names a focal length.",
        }
    ],
    "warnings": [],
}

POINTS_REQUESTS: Final[dict[str, Any]] = {
    "largest-person": {"image_id": PICTURE_ID},
    "second-person-and-mask": {"image_id": PICTURE_ID, "person": 1, "mask": True},
}

POINTS_ANSWER: Final[dict[str, Any]] = {
    "image_size": {"width": 720, "height": 960},
    "persons": [{"box": [163.0, 40.75, 558.68, 895.2], "score": 0.983}],
    "person": 0,
    "points": {
        "left_shoulder": {
            "x": 433.9,
            "y": 214.92,
            "visibility": 2,
            "source": "proposal",
            "confidence": 0.999,
            "expected_error_px": 10.41,
        },
        "left_wrist": {
            "x": 534.47,
            "y": 450.98,
            "visibility": 1,
            "source": "proposal",
            "confidence": 0.31,
            "expected_error_px": 25.55,
        },
    },
    "doubtful": ["left_wrist"],
    "mask": None,
    "warnings": [
        {
            "code": "limbs-crossed",
            "message": (
                "Arms or legs cross in the picture: see whether left and right are the right ones."
            ),
        }
    ],
}

CHECK_REQUESTS: Final[dict[str, Any]] = {
    "front": {"image_id": PICTURE_ID, "view": "front", "height_m": 1.8},
    "nothing-said": {"image_id": PICTURE_ID},
}

_CHECKED: Final[dict[str, Any]] = {
    "image_size": {"width": 720, "height": 960},
    "usable": True,
    "findings": [],
    "not_checked": [],
    "box": [163.0, 40.75, 558.68, 895.2],
    "seen_from": "front",
    "lean_deg": -0.1,
    "distance_m": 3.03,
    "assumptions": [],
    "warnings": [],
}

CHECK_ANSWERS: Final[dict[str, Any]] = {
    "good-picture": _CHECKED,
    "to-be-taken-again": _CHECKED
    | {
        "usable": False,
        "findings": [
            {
                "code": "other-view",
                "severity": "blocks",
                "reason": (
                    "The person is to be seen from the front and is turned from the camera by "
                    "about 81 degrees, where 0 are meant."
                ),
                "remedy": "Have the person turn until the camera sees them from the front.",
                "points": ["left_shoulder", "right_shoulder", "left_hip", "right_hip"],
                "box": None,
            },
        ],
        "not_checked": [
            {
                "code": "camera-too-near",
                "reason": "Neither the request nor the picture's EXIF data names a focal length.",
            }
        ],
        "seen_from": "side",
        "distance_m": None,
    },
}

BODY_REQUESTS: Final[dict[str, Any]] = {
    "height-and-weight": {"gender": "female", "height_m": 1.68, "weight_kg": 64.5},
    "girths": {
        "gender": "male",
        "measurements": {
            "stature": {"value": 180, "standard_error": 1},
            "waist_girth_navel": 88,
        },
        "include_glb": True,
    },
    "gender-alone": {"gender": "female"},
}

BODY_ANSWER: Final[dict[str, Any]] = {
    "gender": "female",
    "height_m": 1.68,
    "shape": [1.1084, -1.0509, -0.1322],
    "measurements": [
        {
            "name": "weight",
            "value": 64.5,
            "unit": "kg",
            "standard_error": 0.0,
            "low": 64.5,
            "high": 64.5,
            "given": True,
            "definition": (
                "Volume of the body in the canonical pose times the density of water, 1000 kg per "
                "cubic metre."
            ),
            "source": "Guan et al. 2009, section 6.",
        },
        {
            "name": "waist_girth_navel",
            "value": 82.8,
            "unit": "cm",
            "standard_error": 5.2,
            "low": 72.6,
            "high": 92.9,
            "given": False,
            "definition": (
                "Level tape around the trunk at the height of the navel: the waist of surveys."
            ),
            "source": (
                "Guan et al. 2009, section 6 (plane cut, convex hull); ANSUR II "
                "waistcircumference (omphalion)."
            ),
        },
    ],
    "plausibility": 0.31,
    "body_model": "a36fddfa54208ca9bcb202d5a591ca5e90624015b833167abe83db0f1a899931",
    "glb": None,
}
