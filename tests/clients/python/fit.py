"""Fit the sample through the generated client and print what came of it as JSON.

``python fit.py SERVICE PICTURE REQUEST``
"""

import json
import sys
import time
from pathlib import Path

from maquette_client import Client
from maquette_client.api.fits import erase, get_fit, submit
from maquette_client.api.results import artifact, result
from maquette_client.models import FitRequest, FitResult, Job, JobState, SubmitFilesBody
from maquette_client.types import File


def main(service: str, picture: Path, request: Path) -> None:
    client = Client(base_url=service, raise_on_unexpected_status=True)
    with picture.open("rb") as image:
        job = submit.sync(
            client=client,
            body=SubmitFilesBody(
                image=File(payload=image, file_name=picture.name, mime_type="image/jpeg"),
                request=FitRequest.from_dict(json.loads(request.read_text())),
            ),
        )
    assert isinstance(job, Job), job
    while job.state in (JobState.QUEUED, JobState.RUNNING):
        time.sleep(0.3)
        job = get_fit.sync(job.id, client=client)
        assert isinstance(job, Job), job
    assert job.state is JobState.SUCCEEDED, job.problem

    found = result.sync(job.id, client=client)
    assert isinstance(found, FitResult), found
    body = artifact.sync(job.id, "body_posed.glb", client=client)
    assert isinstance(body, File), body
    print(
        json.dumps(
            {
                "measurements": {each.name: each.value for each in found.measurements},
                "glb": body.payload.read(4).decode(),
                "erased": erase.sync_detailed(job.id, client=client).status_code,
            }
        )
    )


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]))
