"""A size: made of the person, and of a chart in the request or beside it."""

from typing import Final

from api_schemas.derivation_kinds import AnyDerivationOptions, DerivationKind
from api_schemas.derivation_kinds.size import SizeOptions, SizeResult, options_faults
from api_schemas.problems import FieldProblem, problem
from api_schemas.size_chart_csv import MAX_CHART_BYTES, ChartTableError, read_chart
from service.api.derivation_kinds.definition import DerivationKindDefinition, FormPart, Needs
from service.api.examples.files import files
from service.jobs.inputs import CHART, PERSON, RESULT
from service.submissions.refusal import RefusedError, refused


def _check(chart: bytes, options: AnyDerivationOptions, max_pixels: int) -> str:
    """Read the chart; returns its media type."""
    del max_pixels
    if len(chart) > MAX_CHART_BYTES:
        raise RefusedError(
            problem(
                "payload-too-large",
                field=CHART,
                detail=f"The chart has {len(chart)} bytes, more than {MAX_CHART_BYTES}.",
                remedy="Send the sizes of one garment alone.",
            )
        )
    try:
        read = read_chart(chart)
    except ChartTableError as error:
        raise refused(
            FieldProblem(field=CHART, code=error.code, reason=error.reason, remedy=error.remedy)
        ) from error
    assert isinstance(options, SizeOptions)
    faults = options_faults(options, read)
    if faults:
        raise refused(*faults)
    return "text/csv"


TABLE: Final = FormPart(
    name=CHART,
    description=(
        "A size chart as CSV in UTF-8: a header `size,chest_girth,waist_girth_navel` with the "
        "names of measurements, then a row for each size, `M,94-98,80-84`, in centimetres."
    ),
    media_types="text/csv, text/plain, application/octet-stream",
    sent_for="a size without a chart in the request",
    check=_check,
)


def _needs(options: SizeOptions) -> Needs:
    of_fit = (PERSON, RESULT)
    if options.chart is not None or options.chart_csv is not None:
        return Needs(of_fit=of_fit)
    return Needs(
        of_fit=of_fit, part=TABLE, part_is_for="holds the sizes, as does the field 'chart'"
    )


KIND: Final = DerivationKindDefinition(
    kind=DerivationKind.SIZE,
    options=SizeOptions,
    result=SizeResult,
    needs=_needs,
    part=TABLE,
    requests={
        "size": {
            "kind": "size",
            "chart": {
                "sizes": [
                    {
                        "label": label,
                        "measurements": {
                            "chest_girth": {"low": chest, "high": chest + 4},
                            "waist_girth_navel": {"low": waist, "high": waist + 4},
                        },
                    }
                    for label, chest, waist in (("S", 90, 76), ("M", 94, 80), ("L", 98, 84))
                ]
            },
        },
        "size-of-a-table": {
            "kind": "size",
            "chart_csv": "size,chest_girth,waist_girth_navel\nS,90-94,76-80\nM,94-98,80-84\n",
            "ease": {"waist_girth_navel": 2},
            "tolerances": {"waist_girth_navel": {"too_small": 1, "too_large": 4}},
        },
    },
    answer={
        "artifacts": files(sizes__csv=121),
        "kind": "size",
        "recommended": "M",
        "compared_with": "M",
        "none_fits": 0.05,
        "sizes": [
            {"label": "S", "probability": 0.09, "cost": 2.0, "fits": False},
            {"label": "M", "probability": 0.52, "cost": 0.15, "fits": True},
            {"label": "L", "probability": 0.34, "cost": 0.43, "fits": True},
        ],
        "arguments": [
            {
                "name": "chest_girth",
                "value": 96.3,
                "unit": "cm",
                "standard_error": 2.3,
                "ease": 0.0,
                "low": 94.0,
                "high": 98.0,
                "sized_as": "within",
                "off": 0.0,
                "cost": 0.0,
                "within": 0.61,
                "too_small": 0.23,
                "too_large": 0.16,
                "sizes": ["M", "L"],
                "remark": "chest_girth 96.3 ± 2.3 cm: within M (94 to 98); between M and L.",
            },
            {
                "name": "waist_girth_navel",
                "value": 84.3,
                "unit": "cm",
                "standard_error": 2.2,
                "ease": 0.0,
                "low": 80.0,
                "high": 84.0,
                "sized_as": "too_small",
                "off": 0.3,
                "cost": 0.15,
                "within": 0.42,
                "too_small": 0.55,
                "too_large": 0.03,
                "sizes": ["M", "L"],
                "remark": "waist_girth_navel 84.3 ± 2.2 cm: 0.3 cm more than M is made for "
                "(80 to 84); between M and L.",
            },
        ],
        "warnings": [],
    },
)
