"""Our own tables, next to those of DBOS in the same database."""

import sqlalchemy as sa

METADATA = sa.MetaData()

LABEL = sa.String(80).with_variant(sa.String(80, collation="C"), "postgresql")
"""Compared and sorted by its characters, in any database and whatever its language."""

JOBS = sa.Table(
    "maquette_jobs",
    METADATA,
    sa.Column("id", sa.String(36), primary_key=True),
    sa.Column("tenant", sa.String(64), nullable=False),
    sa.Column("kind", sa.String(32), nullable=False),
    sa.Column("parent_id", sa.String(36)),
    sa.Column("product", sa.String(32)),
    sa.Column("pictures", sa.Integer, nullable=False),
    sa.Column("label", LABEL),
    sa.Column("turn", sa.Integer, nullable=False),
    sa.Column("state", sa.String(16), nullable=False),
    sa.Column("stage", sa.String(64)),
    sa.Column("view", sa.Integer),
    sa.Column("progress", sa.Double, nullable=False),
    sa.Column("attempt", sa.Integer, nullable=False),
    sa.Column("crashes", sa.Integer, nullable=False),
    sa.Column("claimed_by", sa.String(64)),
    sa.Column("cancel_requested", sa.Boolean, nullable=False),
    sa.Column("created_at", sa.Double, nullable=False),
    sa.Column("started_at", sa.Double),
    sa.Column("finished_at", sa.Double),
    sa.Column("expires_at", sa.Double),
    sa.Column("options_digest", sa.String(64), nullable=False),
    sa.Column("inputs", sa.Text, nullable=False),
    sa.Column("files", sa.Text, nullable=False),
    sa.Column("problem", sa.Text),
    sa.Column("idempotency_key", sa.String(64)),
    sa.Column("fingerprint", sa.String(64)),
    sa.Column("request_id", sa.String(64)),
    sa.Column("last_event", sa.Integer, nullable=False),
    sa.Column("webhook_target", sa.String(64)),
    sa.Column("worker_deaths", sa.Integer),
    sa.UniqueConstraint("tenant", "idempotency_key", name="maquette_jobs_key"),
    sa.UniqueConstraint("parent_id", "product", name="maquette_jobs_product"),
    sa.Index("maquette_jobs_newest", "tenant", "parent_id", "created_at", "id"),
    sa.Index("maquette_jobs_label", "tenant", "label", "created_at", "id"),
    sa.Index("maquette_jobs_state", "state", "created_at"),
    sa.Index("maquette_jobs_expiry", "expires_at"),
)
"""Fits and products; a product names in ``parent_id`` the fit it is made of, and in ``product``
what of it. ``inputs`` are blobs by name, as JSON, in the fit's scope, ``pictures`` of them pictures
of a person; ``webhook_target`` is the digest of another, which holds whom to notify and the secret
to sign with. It is not in the database, because databases keep what was deleted in dead rows, logs
and backups. ``turn`` says when it is begun (:mod:`service.jobs.submit`). ``claimed_by`` is the
worker that runs the job or is about to (:mod:`service.jobs.claims`); ``worker_deaths`` counts
those that died over it, and is None until one did."""

EVENTS = sa.Table(
    "maquette_events",
    METADATA,
    sa.Column(
        "job_id",
        sa.String(36),
        sa.ForeignKey("maquette_jobs.id", ondelete="CASCADE"),
        primary_key=True,
    ),
    sa.Column("number", sa.Integer, primary_key=True),
    sa.Column("kind", sa.String(16), nullable=False),
    sa.Column("data", sa.Text, nullable=False),
)

ERASURES = sa.Table(
    "maquette_erasures",
    METADATA,
    sa.Column("scope", sa.String(64), primary_key=True),
    sa.Column("due_at", sa.Double, nullable=False),
    sa.Index("maquette_erasures_due", "due_at"),
)
"""Scopes of blobs to be erased from ``due_at`` on: those of jobs that are gone, and those of
unfinished submissions, which are removed again when the job is accepted."""

IMAGES = sa.Table(
    "maquette_images",
    METADATA,
    sa.Column("tenant", sa.String(64), primary_key=True),
    sa.Column("id", sa.String(64), primary_key=True),
    sa.Column("scope", sa.String(64), nullable=False),
    sa.Column("media_type", sa.String(64), nullable=False),
    sa.Column("width", sa.Integer, nullable=False),
    sa.Column("height", sa.Integer, nullable=False),
    sa.Column("size", sa.BigInteger, nullable=False),
    sa.Column("focal_length_35mm", sa.Double),
    sa.Column("created_at", sa.Double, nullable=False),
    sa.Column("expires_at", sa.Double, nullable=False),
    sa.Index("maquette_images_expiry", "expires_at"),
)
"""Pictures uploaded before any fit; ``id`` is the SHA-256 of the file, the blob's name in its
scope."""

TOMBSTONES = sa.Table(
    "maquette_tombstones",
    METADATA,
    sa.Column("id", sa.String(36), primary_key=True),
    sa.Column("tenant", sa.String(64), nullable=False),
    sa.Column("expired_at", sa.Double, nullable=False),
    sa.Index("maquette_tombstones_age", "expired_at"),
)
"""Ids of fits that have expired: nothing else is kept of them."""

API_KEYS = sa.Table(
    "maquette_api_keys",
    METADATA,
    sa.Column("id", sa.String(16), primary_key=True),
    sa.Column("tenant", sa.String(64), nullable=False),
    sa.Column("secret_hash", sa.String(64), nullable=False, unique=True),
    sa.Column("created_at", sa.Double, nullable=False),
    sa.Column("revoked_at", sa.Double),
)

OUTCOMES = sa.Table(
    "maquette_outcomes",
    METADATA,
    sa.Column("state", sa.String(16), primary_key=True),
    sa.Column("jobs", sa.BigInteger, nullable=False),
)
"""Numbers of jobs that have ever ended in each state; erasing a job does not lower them."""

DURATIONS = sa.Table(
    "maquette_durations",
    METADATA,
    sa.Column("phase", sa.String(64), primary_key=True),
    sa.Column("bucket", sa.Double, primary_key=True),
    sa.Column("jobs", sa.BigInteger, nullable=False),
    sa.Column("seconds", sa.Double, nullable=False),
)
"""Durations of phases of jobs, as a histogram: ``bucket`` is an upper bound in seconds."""

WORKERS = sa.Table(
    "maquette_workers",
    METADATA,
    sa.Column("executor_id", sa.String(64), primary_key=True),
    sa.Column("machine", sa.String(200), nullable=False),
    sa.Column("pid", sa.Integer, nullable=False),
    sa.Column("pid_started", sa.String(32), nullable=False),
    sa.Column("beat", sa.Integer, nullable=False),
    sa.Column("able", sa.Boolean, nullable=False),
)
"""Workers that beat; one that is not ``able`` is alive and cannot start the process of a job."""

FACTS = sa.Table(
    "maquette_facts",
    METADATA,
    sa.Column("name", sa.String(64), primary_key=True),
    sa.Column("value", sa.Text, nullable=False),
)
