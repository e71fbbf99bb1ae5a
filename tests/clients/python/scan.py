"""Measure the sample pair through the generated client and print what came of it as JSON.

``python scan.py SERVICE FRONT SIDE REQUEST``, once with pictures in the form, once uploaded before.
"""

import io
import json
import sys
import time
from pathlib import Path

from maquette_client import Client
from maquette_client.api.images import erase_image, upload_image
from maquette_client.api.scans import (
    erase_scan,
    follow_scan,
    get_scan,
    get_scan_artifact,
    get_scan_result,
    submit_scan,
)
from maquette_client.models import (
    JobState,
    Scan,
    ScanOfImages,
    ScanRequest,
    ScanResult,
    SubmitScanFilesBody,
    UploadedImage,
    UploadImageBody,
)
from maquette_client.types import File


def picture_file(picture: Path) -> File:
    content = io.BytesIO(picture.read_bytes())
    return File(payload=content, file_name=picture.name, mime_type="image/jpeg")


def submitted_as_form(client: Client, front: Path, side: Path, request: Path) -> Scan:
    asked = ScanRequest.from_dict(json.loads(request.read_text()))
    form = SubmitScanFilesBody(
        image_0=picture_file(front), image_1=picture_file(side), request=asked
    )
    scan = submit_scan.sync(client=client, body=form)
    assert isinstance(scan, Scan), scan
    return scan


def submitted_as_json(client: Client, images: list[UploadedImage], request: Path) -> Scan:
    asked = json.loads(request.read_text())
    for view, image in zip(asked["views"], images, strict=True):
        view["image_id"] = image.id
    scan = submit_scan.sync(client=client, body=ScanOfImages.from_dict(asked))
    assert isinstance(scan, Scan), scan
    return scan


def uploaded(client: Client, picture: Path) -> UploadedImage:
    kept = upload_image.sync(client=client, body=UploadImageBody(image=picture_file(picture)))
    assert isinstance(kept, UploadedImage), kept
    return kept


def ended(client: Client, scan: Scan) -> ScanResult:
    while scan.state in (JobState.QUEUED, JobState.RUNNING):
        time.sleep(0.3)
        seen = get_scan.sync(scan.id, client=client)
        assert isinstance(seen, Scan), seen
        scan = seen
    assert scan.state is JobState.SUCCEEDED, scan.problem
    found = get_scan_result.sync(scan.id, client=client)
    assert isinstance(found, ScanResult), found
    return found


def main(service: str, front: Path, side: Path, request: Path) -> None:
    client = Client(base_url=service, raise_on_unexpected_status=True)
    images = [uploaded(client, picture) for picture in (front, side)]
    scans = [
        submitted_as_form(client, front, side, request),
        submitted_as_json(client, images, request),
    ]
    results = [ended(client, scan) for scan in scans]
    body = get_scan_artifact.sync(scans[0].id, "body_posed_1.glb", client=client)
    assert isinstance(body, File), body
    events = follow_scan.sync(scans[0].id, client=client)
    assert isinstance(events, str), events
    erased = [erase_scan.sync_detailed(scan.id, client=client).status_code for scan in scans]
    erased += [erase_image.sync_detailed(image.id, client=client).status_code for image in images]
    print(
        json.dumps(
            {
                "measurements": [
                    {each.name: each.value for each in found.measurements} for found in results
                ],
                "views": [view.view for view in results[0].views],
                "glb": body.payload.read(4).decode(),
                "ends": events.count("event: end"),
                "erased": erased,
            }
        )
    )


if __name__ == "__main__":
    main(sys.argv[1], *(Path(each) for each in sys.argv[2:5]))
