"""Fit the sample through the generated client and print what came of it as JSON.

``python fit.py SERVICE PICTURE REQUEST``, once with the picture in the form, once uploaded before.
"""

import io
import json
import sys
import time
from pathlib import Path

from maquette_client import Client
from maquette_client.api.fits import erase_fit, follow_fit, get_fit, submit_fit
from maquette_client.api.images import erase_image, upload_image
from maquette_client.api.results import get_fit_artifact, get_fit_result
from maquette_client.models import (
    FitOfImage,
    FitRequest,
    FitResult,
    Job,
    JobState,
    SubmitFitFilesBody,
    UploadedImage,
    UploadImageBody,
)
from maquette_client.types import File


def picture_file(picture: Path) -> File:
    content = io.BytesIO(picture.read_bytes())
    return File(payload=content, file_name=picture.name, mime_type="image/jpeg")


def submitted_as_form(client: Client, picture: Path, request: Path) -> Job:
    asked = FitRequest.from_dict(json.loads(request.read_text()))
    form = SubmitFitFilesBody(image=picture_file(picture), request=asked)
    job = submit_fit.sync(client=client, body=form)
    assert isinstance(job, Job), job
    return job


def submitted_as_json(client: Client, image: UploadedImage, request: Path) -> Job:
    asked = FitOfImage.from_dict({"image_id": image.id, **json.loads(request.read_text())})
    job = submit_fit.sync(client=client, body=asked)
    assert isinstance(job, Job), job
    return job


def uploaded(client: Client, picture: Path) -> UploadedImage:
    kept = upload_image.sync(client=client, body=UploadImageBody(image=picture_file(picture)))
    assert isinstance(kept, UploadedImage), kept
    return kept


def ended(client: Client, job: Job) -> FitResult:
    while job.state in (JobState.QUEUED, JobState.RUNNING):
        time.sleep(0.3)
        seen = get_fit.sync(job.id, client=client)
        assert isinstance(seen, Job), seen
        job = seen
    assert job.state is JobState.SUCCEEDED, job.problem
    found = get_fit_result.sync(job.id, client=client)
    assert isinstance(found, FitResult), found
    return found


def main(service: str, picture: Path, request: Path) -> None:
    client = Client(base_url=service, raise_on_unexpected_status=True)
    image = uploaded(client, picture)
    jobs = [
        submitted_as_form(client, picture, request),
        submitted_as_json(client, image, request),
    ]
    measured = [{each.name: each.value for each in ended(client, job).measurements} for job in jobs]
    body = get_fit_artifact.sync(jobs[0].id, "body_posed.glb", client=client)
    assert isinstance(body, File), body
    events = follow_fit.sync(jobs[0].id, client=client)
    assert isinstance(events, str), events
    erased = [erase_fit.sync_detailed(job.id, client=client).status_code for job in jobs]
    erased.append(erase_image.sync_detailed(image.id, client=client).status_code)
    print(
        json.dumps(
            {
                "measurements": measured,
                "glb": body.payload.read(4).decode(),
                "ends": events.count("event: end"),
                "erased": erased,
            }
        )
    )


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]))
