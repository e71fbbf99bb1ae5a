"""Pictures uploaded by a tenant before any fit: their records, next to those of jobs.

The blob of a picture lies in a scope of its own. As with jobs, the scope is listed for erasure
until the record is there, and again as soon as the record is gone (see
:mod:`service.jobs.sweep`). A fit copies the picture into the job's scope, so neither depends on
the other.
"""

import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

import sqlalchemy as sa
from sqlalchemy.exc import IntegrityError

from service.jobs.database import available
from service.jobs.sweep import ABANDONED_AFTER_S, enter_erasures, take_out
from service.jobs.tables import IMAGES
from service.settings import Settings


@dataclass(frozen=True, slots=True, kw_only=True)
class NewImage:
    """An uploaded picture to keep; its blob, named ``id``, is already in ``scope``.

    ``width`` and ``height`` are those of the upright picture.
    """

    id: str
    scope: str
    media_type: str
    width: int
    height: int
    size: int
    focal_length_35mm: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ImageRecord(NewImage):
    """A stored picture; times are seconds since the epoch."""

    created_at: float
    expires_at: float


class ImageQuotaError(Exception):
    """There is no room for this picture besides the tenant's others; the message says how many."""


class TenantImages:
    """The uploaded pictures of one tenant; those of others can be neither seen nor touched.

    Every method may raise :class:`service.jobs.records.EngineUnavailableError`.
    """

    def __init__(self, tenant: str, database: sa.Engine, settings: Settings) -> None:
        self._tenant = tenant
        self._database = database
        self._retention_s = settings.retention_s
        self._quota = settings.max_image_bytes_per_tenant

    @available
    def find(self, image_id: str) -> ImageRecord | None:
        """Return the picture, or None if there is none or it has expired."""
        query = sa.select(IMAGES).where(IMAGES.c.id == image_id, *self._seen())
        with self._database.connect() as connection:
            row = connection.execute(query).mappings().one_or_none()
        return None if row is None else _record(row)

    @available
    def images(self, *, limit: int, before: tuple[float, str] | None) -> Sequence[ImageRecord]:
        """Return pictures newest first, after the one that ``before`` names by time and id."""
        query = (
            sa.select(IMAGES)
            .where(*self._seen())
            .order_by(IMAGES.c.created_at.desc(), IMAGES.c.id.desc())
            .limit(limit)
        )
        if before is not None:
            query = query.where(
                sa.tuple_(IMAGES.c.created_at, IMAGES.c.id) < sa.tuple_(*map(sa.literal, before))
            )
        with self._database.connect() as connection:
            return [_record(row) for row in connection.execute(query).mappings()]

    @available
    def renew(self, image_id: str) -> ImageRecord | None:
        """Restart the picture's time, if the same caller has uploaded it."""
        with self._database.begin() as connection:
            return self._renew(connection, image_id)

    @available
    def reserve(self, scope: str, *, size: int) -> None:
        """Announce that a picture of ``size`` bytes is about to be stored in a scope.

        The scope is listed for erasure until the picture is kept: an hour later it is erased.

        Raises
        ------
        ImageQuotaError
            If there is no room for the picture.
        """
        with self._database.begin() as connection:
            self._check_room(connection, size)
            enter_erasures(connection, [scope], due_at=time.time() + ABANDONED_AFTER_S)

    @available
    def keep(self, image: NewImage) -> ImageRecord | None:
        """Keep a picture whose scope was reserved, or return the same one kept in another before.

        None if its scope was considered abandoned and has been erased meanwhile.
        """
        try:
            return self._keep(image)
        except IntegrityError:
            # Two uploads of one picture raced.
            return self._keep(image)

    @available
    def erase(self, image_id: str) -> Sequence[str]:
        """Forget the picture; returns its scope, if any, which the caller should erase.

        If the caller does not get to it, the sweep will.
        """
        with self._database.begin() as connection:
            return _forget(connection, IMAGES.c.id == image_id, *self._seen())

    def _seen(self) -> tuple[sa.ColumnElement[bool], ...]:
        """The condition that a picture is one that the tenant may know of."""
        return (IMAGES.c.tenant == self._tenant, IMAGES.c.expires_at > time.time())

    def _own(self, image_id: str) -> tuple[sa.ColumnElement[bool], ...]:
        return (IMAGES.c.id == image_id, IMAGES.c.tenant == self._tenant)

    def _check_room(self, connection: sa.Connection, size: int) -> None:
        """Raise :class:`ImageQuotaError` unless one more picture of this size is within the quota.

        Concurrent uploads may together exceed it.
        """
        total = connection.execute(
            sa.select(sa.func.coalesce(sa.func.sum(IMAGES.c.size), 0)).where(
                IMAGES.c.tenant == self._tenant, IMAGES.c.expires_at > time.time()
            )
        ).scalar_one()
        if total + size > self._quota:
            message = f"{total} bytes of pictures are kept for you; at most {self._quota} may be."
            raise ImageQuotaError(message)

    def _renew(self, connection: sa.Connection, image_id: str) -> ImageRecord | None:
        now = time.time()
        row = (
            connection.execute(
                sa.update(IMAGES)
                .where(*self._own(image_id), IMAGES.c.expires_at > now)
                .values(expires_at=now + self._retention_s)
                .returning(IMAGES)
            )
            .mappings()
            .one_or_none()
        )
        return None if row is None else _record(row)

    def _keep(self, image: NewImage) -> ImageRecord | None:
        now = time.time()
        with self._database.begin() as connection:
            # One that has expired may not have been swept yet.
            _forget(connection, *self._own(image.id), IMAGES.c.expires_at <= now)
            earlier = self._renew(connection, image.id)
            if earlier is not None:
                return earlier
            if not take_out(connection, image.scope):
                return None
            values: dict[str, Any] = asdict(image)
            values |= {"created_at": now, "expires_at": now + self._retention_s}
            connection.execute(sa.insert(IMAGES).values(tenant=self._tenant, **values))
        return ImageRecord(**values)


def _forget(connection: sa.Connection, *those: sa.ColumnElement[bool]) -> Sequence[str]:
    scopes = (
        connection.execute(sa.delete(IMAGES).where(*those).returning(IMAGES.c.scope))
        .scalars()
        .all()
    )
    if scopes:
        enter_erasures(connection, scopes, due_at=time.time())
    return scopes


def _record(row: sa.RowMapping) -> ImageRecord:
    return ImageRecord(**{each.name: row[each.name] for each in fields(ImageRecord)})
