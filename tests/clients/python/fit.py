"""Fit pictures through the generated client and print what came of it as JSON.

``python fit.py SERVICE REQUEST PICTURE...``, once with the pictures in the form, once uploaded
before.
"""

import io
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from maquette_client import Client
from maquette_client.api.fits import (
    erase_fit,
    follow_fit,
    get_fit,
    get_fit_file,
    get_fit_result,
    submit_fit,
)
from maquette_client.api.images import erase_image, upload_image
from maquette_client.models import (
    Fit,
    FitRequest,
    FitResult,
    JobState,
    SubmitFitBody,
    UploadedImage,
    UploadImageBody,
)
from maquette_client.types import File


def picture_file(picture: Path) -> File:
    content = io.BytesIO(picture.read_bytes())
    return File(payload=content, file_name=picture.name, mime_type="image/jpeg")


def submitted_as_form(client: Client, request: Path, pictures: Sequence[Path]) -> Fit:
    asked = FitRequest.from_dict(json.loads(request.read_text()))
    files = [picture_file(each) for each in pictures]
    fit = submit_fit.sync(client=client, body=SubmitFitBody(image=files, request=asked))
    assert isinstance(fit, Fit), fit
    return fit


def submitted_by_id(client: Client, request: Path, images: Sequence[UploadedImage]) -> Fit:
    asked = json.loads(request.read_text())
    for view, image in zip(asked["views"], images, strict=True):
        view["image_id"] = image.id
    body = SubmitFitBody(request=FitRequest.from_dict(asked))
    fit = submit_fit.sync(client=client, body=body)
    assert isinstance(fit, Fit), fit
    return fit


def uploaded(client: Client, picture: Path) -> UploadedImage:
    kept = upload_image.sync(client=client, body=UploadImageBody(image=picture_file(picture)))
    assert isinstance(kept, UploadedImage), kept
    return kept


def ended(client: Client, fit: Fit) -> FitResult:
    while fit.state in (JobState.QUEUED, JobState.RUNNING):
        time.sleep(0.3)
        seen = get_fit.sync(fit.id, client=client)
        assert isinstance(seen, Fit), seen
        fit = seen
    assert fit.state is JobState.SUCCEEDED, fit.problem
    found = get_fit_result.sync(fit.id, client=client)
    assert isinstance(found, FitResult), found
    return found


def main(service: str, request: Path, pictures: Sequence[Path]) -> None:
    client = Client(base_url=service, raise_on_unexpected_status=True)
    images = [uploaded(client, each) for each in pictures]
    fits = [
        submitted_as_form(client, request, pictures),
        submitted_by_id(client, request, images),
    ]
    results = [ended(client, fit) for fit in fits]
    body = get_fit_file.sync(fits[0].id, "views/0/body_posed.glb", client=client)
    assert isinstance(body, File), body
    events = follow_fit.sync(fits[0].id, client=client)
    assert isinstance(events, str), events
    erased = [erase_fit.sync_detailed(fit.id, client=client).status_code for fit in fits]
    erased += [erase_image.sync_detailed(each.id, client=client).status_code for each in images]
    print(
        json.dumps(
            {
                "measurements": [
                    {each.name: each.value for each in result.measurements} for result in results
                ],
                "views": [view.view for view in results[0].views],
                "glb": body.payload.read(4).decode(),
                "ends": events.count("event: end"),
                "erased": erased,
            }
        )
    )


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), [Path(each) for each in sys.argv[3:]])
