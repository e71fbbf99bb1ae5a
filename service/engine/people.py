"""The people of a tenant: the labels of its fits and scans."""

import time
from collections.abc import Sequence

import sqlalchemy as sa

from service.engine.availability import available
from service.engine.people_port import PersonRecord
from service.engine.port import FIT, SCAN
from service.engine.tables import JOBS


class StoredPeople:
    """Counts the labels of a tenant; see :class:`service.engine.people_port.TenantPeople`."""

    def __init__(self, tenant: str, database: sa.Engine) -> None:
        self._tenant = tenant
        self._database = database

    @available
    def people(self, *, limit: int, after: str | None) -> Sequence[PersonRecord]:
        """Return people by label, in the order of its characters."""
        labelled = (
            JOBS.c.tenant == self._tenant,
            JOBS.c.label.is_not(None),
            sa.or_(JOBS.c.expires_at.is_(None), JOBS.c.expires_at > time.time()),
        )
        counted = sa.select(
            JOBS.c.label,
            _count_of(FIT).label("fits"),
            _count_of(SCAN).label("scans"),
        ).where(*labelled)
        if after is not None:
            counted = counted.where(JOBS.c.label > after)
        page = counted.group_by(JOBS.c.label).order_by(JOBS.c.label).limit(limit).subquery()
        place = sa.func.row_number().over(
            partition_by=JOBS.c.label, order_by=(JOBS.c.created_at.desc(), JOBS.c.id.desc())
        )
        ranked = (
            sa.select(
                page.c.label,
                page.c.fits,
                page.c.scans,
                JOBS.c.root,
                JOBS.c.id,
                JOBS.c.created_at,
                place.label("place"),
            )
            .join(page, page.c.label == JOBS.c.label)
            .where(*labelled)
            .subquery()
        )
        query = sa.select(ranked).where(ranked.c.place == 1).order_by(ranked.c.label)
        with self._database.connect() as connection:
            return [
                PersonRecord(
                    label=row.label,
                    fits=row.fits,
                    scans=row.scans,
                    latest_root=row.root,
                    latest_id=row.id,
                    latest_at=row.created_at,
                )
                for row in connection.execute(query)
            ]


def _count_of(root: str) -> sa.ColumnElement[int]:
    return sa.func.sum(sa.case((JOBS.c.root == root, 1), else_=0))
