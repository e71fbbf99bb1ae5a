"""The cheap check of what is said of a picture that is to be checked itself."""

from api_schemas.checks import CheckRequest
from api_schemas.points import PointsFormat
from service.submissions.point_rules import placed_points
from service.submissions.submission import check_picture


def placed_question(asked: CheckRequest, image: bytes, *, max_pixels: int) -> CheckRequest:
    """The request with named points, which lie in the picture; that is not decoded.

    Raises
    ------
    RefusedError
        As :func:`service.submissions.submission.check_picture` and
        :func:`service.submissions.point_rules.placed_points`.
    """
    header = check_picture("image", image, max_pixels=max_pixels)
    points = placed_points(asked.points, asked.format, width=header.width, height=header.height)
    return asked.model_copy(update={"points": points, "format": PointsFormat.NAMED})
