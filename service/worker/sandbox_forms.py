"""What a sandbox has of two pictures, given the form of a request with others."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from api_schemas.scans import ScanOptions, ScanResult
from fitter.vocabulary.choices import ViewKind
from service.jobs.inputs import file_of
from service.worker.pipeline_port import PipelineOutput

FRONT, SIDE = 0, 1
"""Places of the sample's views."""


def scan_of_views(output: PipelineOutput, asked: ScanOptions) -> PipelineOutput:
    """A scan of as many views as were asked for; any but one from the side is that of the front."""
    result = output.result
    assert isinstance(result, ScanResult)
    places = [SIDE if each.view is ViewKind.SIDE else FRONT for each in asked.views]
    views = tuple(
        result.views[place].model_copy(update={"number": number, "view": each.view})
        for number, (place, each) in enumerate(zip(places, asked.views, strict=True))
    )
    stages = tuple(
        stage.model_copy(update={"views": tuple(stage.views[place] for place in places)})
        for stage in result.stages
    )
    of_a_view = [
        name.replace("_0.", ".")
        for name in output.artifacts
        if name == file_of(name.replace("_0.", "."), FRONT)
    ]
    return replace(
        output,
        result=result.model_copy(update={"views": views, "stages": stages}),
        artifacts=_spread(output.artifacts, of_a_view, places, first=0),
    )


def _spread(
    files: Mapping[str, bytes], names: Sequence[str], places: Sequence[int], *, first: int
) -> dict[str, bytes]:
    """The files, with those of each picture taken from the one at its place.

    Numbers in their names count from ``first``.
    """
    of_pictures = {
        file_of(name, first + number): files[file_of(name, first + place)]
        for number, place in enumerate(places)
        for name in names
    }
    return {**files, **of_pictures}
