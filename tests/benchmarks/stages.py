"""What a fit takes, stage by stage, at two sizes of the picture."""

from collections.abc import Iterator, Sequence

from fitter.fits.progress import Stage
from fitter.training.report.text_tables import note_lines, table_lines
from tests.benchmarks.requests import suite_requests, warm_up
from tests.benchmarks.spent import Spent, TimedFit, late, median, timed_fit

SIZES = ((480, 640), (960, 1280))


def lines(count: int) -> Iterator[str]:
    """One table a size, over ``count`` fits."""
    warm_up()
    for width, height in SIZES:
        fits = [timed_fit(each) for each in suite_requests(count, width=width, height=height)]
        camera = fits[0].result.views[0].camera
        yield from table_lines(
            f"{count} fits with silhouette, edges and shading, {width}x{height} "
            f"(worked on at {camera.width}x{camera.height}), seconds",
            ("", "processor, median", "95 %", "wall, median", "95 %"),
            [
                *_stage_rows(fits),
                _row("in all", [each.whole for each in fits]),
                _row("pictures and meshes, after", [each.export for each in fits]),
            ],
        )
        evaluations = [float(each.result.evaluations) for each in fits]
        yield from note_lines(
            f"Energies computed a fit: median {median(evaluations):.0f}, 95 % "
            f"{late(evaluations):.0f}."
        )


def _stage_rows(fits: Sequence[TimedFit]) -> list[tuple[str, ...]]:
    reported = [stage for stage in Stage if stage in fits[0].stages]
    return [_row(stage.value, [each.stages[stage] for each in fits]) for stage in reported]


def _row(name: str, spent: Sequence[Spent]) -> tuple[str, ...]:
    processor, wall = [each.processor_s for each in spent], [each.wall_s for each in spent]
    figures = (median(processor), late(processor), median(wall), late(wall))
    return (name, *(f"{figure:.3f}" for figure in figures))
