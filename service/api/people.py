"""People: the labels of fits and scans, with how many there are and the newest."""

from datetime import UTC, datetime
from typing import Annotated, Final

from fastapi import APIRouter, Query, Response

from api_schemas.labels import LabelledPerson, LabelOfList, PeoplePage
from service.api.context import Context
from service.api.listing import Limit, page_of
from service.api.problems import documented
from service.engine.people_port import PersonRecord
from service.representation.jobs import collection_path

PATH: Final = "/v1/people"
ROUTER: Final = APIRouter(prefix=PATH, tags=["people"])


@ROUTER.get(
    "",
    response_model=PeoplePage,
    summary="List people by label",
    responses=documented("invalid-request", "not-ready", "internal-error"),
)
def list_people(
    response: Response,
    context: Context,
    limit: Limit = 50,
    cursor: Annotated[
        LabelOfList | None,
        Query(description="From `next` of the page before: the label to go on after."),
    ] = None,
) -> PeoplePage:
    """List the labels of the fits and scans that are kept, in the order of their characters.

    `GET /v1/fits?label=` and `GET /v1/scans?label=` list what a person has. `next` and the Link
    header lead to the following page.
    """
    found = context.people.people(limit=limit + 1, after=cursor)
    page, following = page_of(
        found, response, path=PATH, limit=limit, cursor=lambda last: last.label
    )
    return PeoplePage(people=tuple(map(_represent, page)), next=following)


def _represent(record: PersonRecord) -> LabelledPerson:
    return LabelledPerson(
        label=record.label,
        fits=record.fits,
        scans=record.scans,
        latest=f"{collection_path(record.latest_root)}/{record.latest_id}",
        latest_at=datetime.fromtimestamp(record.latest_at, UTC),
    )
