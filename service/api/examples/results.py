"""Examples of results: the sample picture's own, rounded."""

from typing import Any, Final

_BODY: Final[dict[str, Any]] = {
    "pose": [
        {"part": "pelvis", "rotation": [0.1023, 0.2282, -0.0311]},
        {"part": "spine", "rotation": [-0.0059, -0.038, 0.0419]},
    ],
    "translation_m": [-0.0314, -0.03, 2.9482],
    "shape": [0.8131, -1.3443, 0.2107],
}


def _measurements(weight_kg: float, standard_error: float | None) -> list[dict[str, Any]]:
    return [
        {
            "name": "stature",
            "value": 180.4,
            "unit": "cm",
            "standard_error": 0.0,
            "given": True,
            "definition": (
                "Crown of the head above the soles, standing upright with straight legs."
            ),
            "source": "ISO 8559-1 stature; ANSUR II stature.",
        },
        {
            "name": "weight",
            "value": weight_kg,
            "unit": "kg",
            "standard_error": standard_error,
            "given": False,
            "definition": (
                "Volume of the body in the canonical pose times the density of water, 1000 kg per "
                "cubic metre."
            ),
            "source": "Guan et al. 2009, section 6.",
        },
    ]


RESULT: Final[dict[str, Any]] = {
    "gender": "male",
    "height_m": 1.804,
    "cues": "SES",
    "optimizer": "gauss_newton",
    "outcome": "converged",
    "outcome_explanation": "The energy stopped decreasing.",
    "verdict": "plausible",
    "camera": {
        "focal_length_px": 1054.85,
        "centre_x": 273.86,
        "centre_y": 365.15,
        "width": 547,
        "height": 730,
        "pitch_deg": -7.4,
        "pitch_standard_error_deg": 2.2,
        "roll_deg": -0.3,
        "roll_standard_error_deg": 1.6,
    },
    "image_camera": {
        "focal_length_px": 1386.64,
        "centre_x": 360.0,
        "centre_y": 480.0,
        "width": 720,
        "height": 960,
        "pitch_deg": -7.4,
        "pitch_standard_error_deg": 2.2,
        "roll_deg": -0.3,
        "roll_standard_error_deg": 1.6,
    },
    "focal_length_source": "assumed",
    "body": _BODY,
    "stance": {
        "kind": "standing",
        "probabilities": {"standing": 0.92, "striding": 0.08, "other": 0.0},
    },
    "light": {
        "kind": "point",
        "azimuth_deg": -35.7,
        "elevation_deg": 30.4,
        "distance_m": 2.91,
        "surroundings": None,
    },
    "reflectance": {
        "ambient": 0.0259,
        "specular_exponent": 48.0,
        "mean_albedo": 0.408,
        "mean_specularity": 0.189,
    },
    "energies": {"silhouette": 8.9, "edges": 6.8, "penetration": 0.0, "shading": 83.93},
    "evaluations": 164,
    "silhouette_overlap": 0.952,
    "measurements": _measurements(74.92, 1.87),
    "stages": [
        {
            "name": "SE",
            "energies": {"silhouette": 7.75, "edges": 6.31, "penetration": 0.0},
            "silhouette_overlap": 0.957,
            "body": _BODY,
            "measurements": _measurements(73.23, None),
        }
    ],
    "limb_facing": [
        {
            "limb": "left_upper_arm",
            "facing": "away",
            "source": "energy",
            "ambiguous": True,
            "alternative_energy": 26.01,
        }
    ],
    "assumptions": [
        {
            "quantity": "focal_length_35mm",
            "value": 50.0,
            "reason": "Neither the request nor the picture's EXIF data names a focal length.",
        }
    ],
    "warnings": [
        {
            "code": "ambiguous-limb-facing",
            "message": (
                "left_upper_arm: the picture fits about as well facing the other way. Say which "
                "in limb_facing."
            ),
        }
    ],
    "stage_seconds": {"observation": 0.05, "silhouette_and_edges": 0.9, "shading": 1.1},
    "artifacts": [
        {
            "name": "body_posed.glb",
            "media_type": "model/gltf-binary",
            "size": 1098472,
            "sha256": "d749f854970d25e805a6f10b7ec3a75d2b0060b9eb3333653b6c95baa7a1608c",
        }
    ],
}
