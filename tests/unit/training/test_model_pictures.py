import cv2
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.training.report.model_pictures import write_pictures

pytestmark = pytest.mark.slow


def test_all_sheets_of_a_model_are_written_and_readable(tmp_path):
    model = load_body_model(packaged_model_path("female"))
    written = write_pictures(model, tmp_path / "new" / "folder")
    assert [path.name for path in written] == [
        "female_first_axes.png",
        "female_all_axes.png",
        "female_percentiles.png",
        "female_random_bodies.png",
        "female_extreme_poses.png",
    ]
    for path in written:
        picture = cv2.imread(str(path))
        assert picture is not None
        assert min(picture.shape[:2]) > 500
        assert (picture < 100).any()
