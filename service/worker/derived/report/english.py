"""The report in English."""

from typing import Final

from api_schemas.derivation_kinds.report import Language
from fitter.vocabulary.choices import Gender, ViewKind
from fitter.vocabulary.measurements import Group
from fitter.vocabulary.outcomes import FocalLengthSource, Outcome, Verdict
from service.worker.derived.report.english_measures import MEASUREMENTS
from service.worker.derived.report.wording import (
    Figures,
    FitWords,
    LightWords,
    PictureWords,
    RemarkWords,
    TableWords,
    Wording,
)

_WARNINGS: Final = {
    "ambiguous-limb-facing": (
        "The picture fits about as well with some limbs slanting the other way, toward the camera "
        "or away from it. Say which, and fit again."
    ),
    "low-silhouette-overlap": (
        "The body covers little of the person as cut out of the picture. Check the points and "
        "left and right, or use a mask."
    ),
    "implausible": "These measurements may be those of nobody: the picture contradicts the body.",
    "no-person": (
        "These measurements may be those of nobody: no person is seen where the points are."
    ),
    "shading-not-used": (
        "Too little of the body is visible, unclipped and away from its outline for shading to "
        "say anything; the body is found by outline alone."
    ),
}

ENGLISH: Final = Wording(
    language=Language.ENGLISH,
    figures=Figures(
        decimal_sign=".",
        date="{day} {month} {year}",
        months=(
            *("January", "February", "March", "April", "May", "June", "July"),
            *("August", "September", "October", "November", "December"),
        ),
    ),
    title="Body measurements",
    scan_title="Body measurements",
    footnote=(
        "Measured on the upright body, at its right arm and leg. For people in close-fitting "
        "clothes the true value lies in the range 95 times in 100. This is not a medical device."
    ),
    genders={Gender.FEMALE: "woman", Gender.MALE: "man"},
    subtitle="{about}, from one picture",
    scan_subtitle="{about}, from {count} pictures",
    measurements=MEASUREMENTS,
    table=TableWords(
        number="No.",
        measurement="Measurement",
        value="Value",
        unit="Unit",
        interval="Range (95 %)",
        not_known="not known",
        given="given",
        exact="exact",
        withheld=("No measurements are given: the reasons are below."),
        figures={
            "chest_girth": "Chest",
            "waist_girth_smallest": "Waist",
            "hip_girth": "Hip",
            "weight": "Weight",
        },
        groups={group: group.value for group in Group},
    ),
    light=LightWords(
        heading="Light and skin",
        not_estimated="Not estimated: the body was found by its outline alone.",
        lamp="Lamp",
        from_right="{degrees}° from the right",
        from_left="{degrees}° from the left",
        from_above="{degrees}° from above",
        from_below="{degrees}° from below",
        far_away="far away",
        away="{metres} m away",
        skin="Skin",
        throws_back="throws back {percent} % of the light",
        gloss="Gloss",
        mirrors="mirrors {percent} % of it",
        all_round="Light from all round",
        of_lamp="{percent} % of the lamp's",
    ),
    fit=FitWords(
        fit="How sure it is",
        scan="How sure it is",
        pictures="The pictures",
        how_it_ended="Result",
        ended={
            Outcome.CONVERGED: "The body fits the picture as well as it can.",
            Outcome.EVALUATION_LIMIT: (
                "The search was stopped at its limit before it was done; this is the best body so "
                "far."
            ),
            Outcome.POOR_FIT: (
                "The body does not cover the person well; the points, the gender or the cut-out "
                "may be wrong. Do not rely on these measurements."
            ),
        },
        outcomes={
            Outcome.CONVERGED: "found",
            Outcome.EVALUATION_LIMIT: "stopped at the limit",
            Outcome.POOR_FIT: "poor fit",
        },
        verdicts={
            Verdict.PLAUSIBLE: "Plausible",
            Verdict.IMPLAUSIBLE: "Implausible",
            Verdict.NO_PERSON: "No person",
        },
        contradicted={
            Verdict.IMPLAUSIBLE: (
                "A body was fitted, but the picture cannot be measured: the reasons are below."
            ),
            Verdict.NO_PERSON: "The picture shows no person where the points are.",
        },
        overlap="Overlap",
        overlap_of="body and person overlap by {percent} %",
        overlap_in_view="overlap {percent} %",
        lens="Lens",
        lens_of="{millimetres} mm as on 35 mm film, {source}",
        lens_sources={
            FocalLengthSource.CALLER: "as given",
            FocalLengthSource.EXIF_35MM: "as the picture says",
            FocalLengthSource.EXIF_SENSOR: "as the picture says",
            FocalLengthSource.ASSUMED: "assumed",
        },
        picture="Picture",
        pixels="{width} × {height} pixels",
        agreement="Agreement",
        agreement_of="{percent} % of pairs of pictures of one person differ more than these.",
        views={
            ViewKind.FRONT: "Front",
            ViewKind.SIDE: "Side",
            ViewKind.BACK: "Back",
            ViewKind.OTHER: "Other",
        },
    ),
    remarks=RemarkWords(
        assumed="What was assumed",
        warned="Please note",
        nothing="Nothing.",
        quantities={
            "height_m": "Height",
            "focal_length_35mm": "Lens",
            "points": "Points",
            "outline": "Outline",
        },
        values={},
        reasons={
            "focal_length_35mm": "Neither the request nor the picture says which lens took it.",
        },
        warnings=_WARNINGS,
        findings={},
    ),
    pictures=PictureWords(
        overlay="The body over the picture",
        sides={
            "from the camera": "From the camera",
            "from the right of the picture": "From the right of the picture",
            "from behind": "From behind",
            "from the left of the picture": "From the left of the picture",
        },
        tapes="Where the tapes lie",
        tape_sides={"front": "From the front", "side": "From the side", "back": "From behind"},
        tapes_note="The numbers are those before the measurements.",
    ),
)
