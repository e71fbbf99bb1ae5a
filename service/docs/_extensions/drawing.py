"""What gallery and tutorials show pictures with."""

import io
import json

import matplotlib.pyplot as plt
import numpy as np
from IPython.display import Image as ShownImage
from IPython.display import Markdown, display
from PIL import Image

from fitter import Click, FitRequest, Gender, Person, View
from fitter.arrays import Triangles, Vertices
from fitter.export.views import BodyView, preview
from fitter.reproduction.drawing import Table, table_markdown
from fitter.reproduction.panels import Figure
from service.demo_data.sample import FOLDER

DPI = 100
FIGURE_PX = 1100
QUALITY = 82


def sample_request(name: str = "sample", points: str = "request") -> FitRequest:
    """The request of one of the packaged samples, with its clicks."""
    asked = json.loads((FOLDER / f"{points}.json").read_text())
    (of_view,) = asked["views"]
    view = View(
        image=(FOLDER / f"{name}.jpg").read_bytes(),
        clicks={key: Click(x=at["x"], y=at["y"]) for key, at in of_view["points"].items()},
    )
    person = Person(gender=Gender(asked["gender"]), height_m=asked["height_m"])
    return FitRequest(person=person, views=(view,))


def show(*pictures: bytes | np.ndarray, titles: tuple[str, ...] = ()) -> None:
    """Pictures side by side: files, or arrays of levels."""
    arrays = [
        np.asarray(Image.open(io.BytesIO(each)).convert("RGB")) if isinstance(each, bytes) else each
        for each in pictures
    ]
    shares = [array.shape[1] / array.shape[0] for array in arrays]
    _, axes = plt.subplots(
        1,
        len(arrays),
        figsize=(min(5.0 * sum(shares), 9.0), 9.0 / max(sum(shares), 1.8)),
        dpi=DPI,
        width_ratios=shares,
        squeeze=False,
        layout="constrained",
    )
    for index, (axis, array) in enumerate(zip(axes[0], arrays, strict=True)):
        axis.imshow(array)
        axis.set_axis_off()
        if index < len(titles):
            axis.set_title(titles[index], fontsize=10)
    plt.show()


def bodies_picture(bodies: dict[str, Vertices], triangles: Triangles) -> np.ndarray:
    """Canonical bodies from the front and from the side, at one scale."""
    seen = [
        BodyView(label=title if degrees == 0.0 else "", vertices=vertices, degrees=degrees)
        for title, vertices in bodies.items()
        for degrees in (0.0, 90.0)
    ]
    return preview(seen, triangles)


def show_figure(figure: Figure) -> None:
    """One of the paper's figures, small, with its words."""
    picture = Image.fromarray(figure.picture)
    picture.thumbnail((FIGURE_PX, FIGURE_PX))
    stream = io.BytesIO()
    picture.save(stream, "JPEG", quality=QUALITY, optimize=True)
    display(Markdown(f"**{figure.title}**"))
    display(ShownImage(data=stream.getvalue(), format="jpeg", alt=figure.title))
    display(Markdown(figure.words))


def show_table(table: Table) -> None:
    """Table 1 by one method."""
    display(Markdown(table_markdown(table)))
