"""Every mesh file that leaves the service, made once for all tests of a run, and what each shows.

Of a fit of two pictures, of what is made of it, and of a fit of the sample alone, which the
documents' examples draw. They are made by the pipeline that the workers run, and kept as files,
because that is what foreign readers open. What they are to show follows from the parameters of
results and from no reader of files: axes of the file, metres. Of an animation the body is the exact
SCAPE body of three frames.
"""

import fcntl
import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from api_schemas.fit import FitRequest
from fitter.applications.motion import grounded, in_place, motion_of_cycle, moving_body
from fitter.applications.poses import named_pose, rig_of
from fitter.applications.walk import stride_of
from fitter.arrays import Vertices
from fitter.fits.equipment import PreparedModel, prepared_model
from fitter.parameters import BodyParameters, CameraTilt
from fitter.person.upright import upright_frame, upright_turn
from fitter.vocabulary.choices import Gender
from service.compute.pipeline import fit_task, product_task
from service.compute.tasks import OPTIONS, ChildSetup
from service.demo_data.sample import FOLDER, load_sample
from service.jobs.inputs import SentPicture, named_pictures, product_inputs
from service.submissions.submission import check_submission

MAX_PIXELS = 2_000_000
SETUP = ChildSetup(name="job", max_pixels=MAX_PIXELS)

PRODUCTS: Mapping[str, dict[str, object]] = {
    "texture": {"kind": "texture", "colours": "picture", "size": 512},
    "albedo_texture": {"kind": "texture", "colours": "albedo", "size": 512},
    "pose": {"kind": "pose", "pose": "t_pose"},
    "animation": {"kind": "animation", "motion": "walk"},
    "rig": {"kind": "animation", "motion": "t_pose", "bones": "mixamo"},
    "caricature": {"kind": "caricature", "factor": 1.5},
}
"""What makes meshes of the fit, by the name of the folder its files are put in."""

GLB_FILES = (
    "fit/body_canonical.glb",
    "fit/views/0/body_posed.glb",
    "fit/views/1/body_posed.glb",
    "texture/body_textured.glb",
    "albedo_texture/body_textured.glb",
    "pose/body_reposed.glb",
    "animation/body_animated.glb",
    "animation/body_skinned.glb",
    "rig/body_skinned.glb",
    "caricature/body_caricature.glb",
)


def made_in(folder: Path) -> Path:
    """Make all files below the folder unless another process did, and return where they lie."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        stamp = folder / "complete"
        if not stamp.exists():
            for name, files in _made():
                for each, content in files.items():
                    file = folder / name / each
                    file.parent.mkdir(parents=True, exist_ok=True)
                    file.write_bytes(content)
            stamp.touch()
    return folder


def _made() -> Iterator[tuple[str, Mapping[str, bytes]]]:
    sample = load_sample()
    front, side = ((FOLDER / f"{view}.jpg").read_bytes() for view in ("front", "side"))
    fit = _of_fit((FOLDER / "front_and_side.json").read_bytes(), front, side)
    yield "fit", fit
    yield from _products(PRODUCTS, fit)
    yield "sample", _of_fit(sample.request, sample.image)


def _of_fit(request: bytes, *images: bytes) -> dict[str, bytes]:
    """A fit's files, and its pictures."""
    pictures = tuple(SentPicture(image, None) for image in images)
    asked = FitRequest.model_validate_json(request)
    checked = check_submission(asked, pictures, max_pixels=MAX_PIXELS)
    options = checked.request.model_dump_json().encode()
    files = named_pictures(pictures)
    return {**fit_task(SETUP, {OPTIONS: options, **files}, lambda _: None), **files}


def _products(
    asked_of: Mapping[str, dict[str, object]], there: Mapping[str, bytes]
) -> Iterator[tuple[str, Mapping[str, bytes]]]:
    for name, asked in asked_of.items():
        parts = {OPTIONS: json.dumps(asked).encode(), **product_inputs(there)}
        yield name, product_task(SETUP, parts, lambda _: None)


ROUNDING_M = 2e-5
"""Files hold single precision; parameters lie some metres from the origin."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Shown:
    """What a reader is to find.

    ``frames`` are the bodies at the beginning, the middle and the end; one where nothing moves.
    ``tolerance_m`` bounds how far any vertex may be from there.
    """

    frames: tuple[Vertices, ...]
    vertices: int
    triangles: int
    tolerance_m: float = ROUNDING_M
    cameras: int = 0
    texture: bool = False
    morph_targets: int = 0

    def agrees(self, low: Iterable[float], high: Iterable[float], *, frame: int = 0) -> bool:
        """Whether a bounding box is that of a frame's body."""
        body = self.frames[frame]
        box = np.array([body.min(axis=0), body.max(axis=0)])
        found = np.array([list(low), list(high)], dtype=float)
        return bool(np.abs(found - box).max() <= self.tolerance_m)


def shown_by(name: str, files: Path) -> Shown:
    """What the file of :data:`tests.foreign.artifacts.GLB_FILES` is to show."""
    return _SHOWN[name](_Results(files))


class _Results:
    """Result documents of the fit and of its products."""

    def __init__(self, files: Path) -> None:
        self._files = files
        gender = Gender(self.of("fit")["gender"])
        self.fitted: PreparedModel = _prepared(gender)
        self.model = self.fitted.operators.model
        self.evaluator = self.fitted.operators.evaluator

    def of(self, folder: str) -> Mapping[str, Any]:
        return json.loads((self._files / folder / "result.json").read_text())

    def first(self) -> Mapping[str, Any]:
        """The person in the first picture."""
        return self.of("fit")["views"][0]

    def shown(self, *frames: Vertices, **more: Any) -> Shown:
        counts = {"vertices": len(self.model.mean_vertices), "triangles": len(self.model.triangles)}
        return Shown(frames=frames, **(counts | more))

    def posed(
        self, body: Mapping[str, Any], tilt: Mapping[str, Any] | None = None, **more: Any
    ) -> Shown:
        """A body under its camera, by default that of the first picture, upright."""
        parameters = _parameters(body)
        vertices = self.evaluator.vertices(parameters)
        world = upright_frame(
            _tilt(tilt or self.first()["tilt"]), vertices=vertices, root=parameters.translation
        )
        return self.shown(world.points(vertices), cameras=1, **more)

    def in_view(self, number: int) -> Shown:
        view = self.of("fit")["views"][number]
        return self.posed(view["body"], view["tilt"])

    def textured(self, **more: Any) -> Shown:
        corners = len(self.model.uv)
        return self.posed(self.first()["body"], vertices=corners, texture=True, **more)

    def dressed(self, shown: Shown) -> Shown:
        """The same in the picture's colours, which cut the skin."""
        return replace(shown, vertices=len(self.model.uv), texture=True)

    def canonical(self, shape: Iterable[float]) -> Shown:
        return self.shown(_standing(self.fitted.measuring.canonical.at(np.array(list(shape)))))

    def upright(self, body: BodyParameters) -> Shown:
        return self.shown(_standing(self.evaluator.body_frame_vertices(body)))

    def turned_upright(self, body: BodyParameters) -> Shown:
        """Upright as the picture has it."""
        turn = upright_turn(_tilt(self.first()["tilt"]))
        return self.shown(_standing(self.evaluator.body_frame_vertices(body) @ turn.T))

    def rigged(self, pose: str) -> Shown:
        shape = np.array(self.first()["body"]["shape"])
        held = named_pose(rig_of(self.model, shape), pose)
        return self.upright(BodyParameters(pose=held, translation=np.zeros(3), shape=shape))

    def animated(self, *, error: str, **more: Any) -> Shown:
        """The walk that ships with the package, in place, by exact SCAPE."""
        shape = np.array(self.first()["body"]["shape"])
        rig = rig_of(self.model, shape)
        motion = motion_of_cycle(stride_of(rig), rig)
        body = in_place(grounded(moving_body(self.evaluator, shape, motion), self.model))
        last = len(body.shapes) - 1
        stated_m = 1e-3 * self.of("animation")[error]
        frames = tuple(body.vertices(frame) for frame in (0, last // 2, last))
        return self.shown(*frames, tolerance_m=stated_m + ROUNDING_M, **more)


@cache
def _prepared(gender: Gender) -> PreparedModel:
    return prepared_model(gender, models=None)


def _parameters(body: Mapping[str, Any]) -> BodyParameters:
    return BodyParameters(
        pose=np.array(list(body["pose"].values())),
        translation=np.array(body.get("translation_m", np.zeros(3))),
        shape=np.array(body["shape"]),
    )


def _tilt(found: Mapping[str, Any]) -> CameraTilt:
    return CameraTilt(
        pitch=np.radians(found["pitch_deg"]),
        roll=np.radians(found["roll_deg"]),
        covariance=np.eye(2),
        stances={},
    )


def _standing(vertices: Vertices) -> Vertices:
    return vertices - np.array([0.0, vertices[:, 1].min(), 0.0])


_SHOWN: Mapping[str, Callable[[_Results], Shown]] = {
    "fit/body_canonical.glb": lambda r: r.canonical(r.of("fit")["shape"]),
    "fit/views/0/body_posed.glb": lambda r: r.in_view(0),
    "fit/views/1/body_posed.glb": lambda r: r.in_view(1),
    "texture/body_textured.glb": lambda r: r.textured(),
    "albedo_texture/body_textured.glb": lambda r: r.textured(),
    "pose/body_reposed.glb": lambda r: r.dressed(
        r.upright(_parameters(r.of("pose") | {"shape": r.first()["body"]["shape"]}))
    ),
    "animation/body_animated.glb": lambda r: r.dressed(
        r.animated(error="morph_largest_error_mm", morph_targets=r.of("animation")["morph_targets"])
    ),
    "animation/body_skinned.glb": lambda r: r.dressed(r.animated(error="skin_largest_error_mm")),
    "rig/body_skinned.glb": lambda r: r.dressed(r.rigged("t_pose")),
    "caricature/body_caricature.glb": lambda r: r.turned_upright(
        _parameters(r.first()["body"] | {"shape": r.of("caricature")["shape"]})
    ),
}
