"""What a setting must be that is more than a number: folders, addresses, lists, a secret.

Each type checks one value by itself; its errors say what to write.
"""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Final

from pydantic import AfterValidator

from api_schemas.webhooks import secret_key
from fitter.detection.weights import BODY_LANDMARKS, PERSON_DETECTOR
from service.setting_addresses import (
    check_bucket,
    check_host_name,
    check_origin,
    check_web_address,
    read_database_url,
)


def split_list(text: str) -> tuple[str, ...]:
    """Read a list separated by commas."""
    return tuple(each.strip() for each in text.split(",") if each.strip())


def _that_passes(check: Callable[[str], object]) -> AfterValidator:
    def checked(text: str) -> str:
        check(text)
        return text

    return AfterValidator(checked)


def _each_passes(check: Callable[[str], None]) -> AfterValidator:
    def checked(text: str) -> str:
        for each in split_list(text):
            check(each)
        return text

    return AfterValidator(checked)


def _check_ports(text: str) -> None:
    ports = split_list(text)
    if not ports or not all(
        re.fullmatch(r"\d{1,5}", each) and 1 <= int(each) <= 65_535 for each in ports
    ):
        message = "write numbers from 1 to 65535 separated by commas, as in 443,80"
        raise ValueError(message)


def _check_pauses(text: str) -> None:
    if not all(re.fullmatch(r"\s*\d{1,6}(\.\d+)?\s*", each) for each in text.split(",")):
        message = "write seconds separated by commas, as in 5,300,1800"
        raise ValueError(message)


def _named(folder: Path) -> Path:
    if folder == Path():
        message = "name a folder, or unset it for the default"
        raise ValueError(message)
    return folder


def _with_both_models(folder: Path) -> Path:
    for name in ("female.npz", "male.npz"):
        if not (folder / name).is_file():
            message = f"no {name} in {folder}: train one, or copy the packaged one there"
            raise ValueError(message)
    return folder


DETECTOR_FILES: Final = (PERSON_DETECTOR.name, BODY_LANDMARKS.name)


def _with_both_weights(folder: Path) -> Path:
    for name in DETECTOR_FILES:
        if not (folder / name).is_file():
            message = (
                f"no {name} in {folder}: copy it there from the package mediapipe 0.10.21, or "
                "unset it where that is installed"
            )
            raise ValueError(message)
    return folder


NamedFolder = Annotated[Path, AfterValidator(_named)]
ModelFolder = Annotated[Path, AfterValidator(_with_both_models)]
DetectorFolder = Annotated[Path, AfterValidator(_with_both_weights)]
DatabaseUrl = Annotated[str, AfterValidator(read_database_url)]
BucketUrl = Annotated[str, _that_passes(check_bucket)]
WebAddress = Annotated[str, _that_passes(check_web_address)]
WebhookSecret = Annotated[str, _that_passes(secret_key)]
Origins = Annotated[str, _each_passes(check_origin)]
HostNames = Annotated[str, _each_passes(check_host_name)]
Ports = Annotated[str, _that_passes(_check_ports)]
Pauses = Annotated[str, _that_passes(_check_pauses)]
