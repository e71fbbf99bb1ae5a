"""A picture fitted over HTTP by the paper's own method."""

import json

import httpx

from api_schemas.results import FitResult
from tests.e2e.service import ended_job
from tests.submissions import small_submissions


def test_a_fit_by_the_papers_method_has_its_energies_alone_and_says_what_differs(
    service: httpx.Client,
):
    (sent,) = small_submissions(1)
    request = json.loads(sent.request) | {
        "cues": "SES",
        "force": True,
        "paper": {"energies": ["silhouette", "penetration", "shading"]},
    }
    answer = service.post(
        "/v1/fits",
        files={"image": ("picture.png", sent.image, "image/png")},
        data={"request": json.dumps(request)},
    )
    job = ended_job(service, answer)
    assert job["state"] == "succeeded", job
    result = FitResult.model_validate_json(service.get(job["links"]["result"]).content)
    assert set(result.energies) <= {"silhouette", "penetration", "shading"}
    assert "silhouette" in result.energies
    assert any("MakeHuman" in each for each in result.differences)
    assert all(each.standard_error in (None, 0.0) for each in result.measurements)
    assert service.get(job["links"]["request"]).json()["paper"] == {
        "energies": ["silhouette", "penetration", "shading"],
        "free_height": False,
    }
