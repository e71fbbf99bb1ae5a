"""The tables of our own, beside those of DBOS in the same database."""

import sqlalchemy as sa

METADATA = sa.MetaData()

JOBS = sa.Table(
    "maquette_jobs",
    METADATA,
    sa.Column("id", sa.String(36), primary_key=True),
    sa.Column("state", sa.String(16), nullable=False),
    sa.Column("stage", sa.String(64)),
    sa.Column("progress", sa.Double, nullable=False),
    sa.Column("attempt", sa.Integer, nullable=False),
    sa.Column("crashes", sa.Integer, nullable=False),
    sa.Column("claimed_by", sa.String(64)),
    sa.Column("cancel_requested", sa.Boolean, nullable=False),
    sa.Column("created_at", sa.Double, nullable=False),
    sa.Column("started_at", sa.Double),
    sa.Column("finished_at", sa.Double),
    sa.Column("options", sa.Text, nullable=False),
    sa.Column("image_digest", sa.String(64), nullable=False),
    sa.Column("image_media_type", sa.String(64), nullable=False),
    sa.Column("mask_digest", sa.String(64)),
    sa.Column("mask_media_type", sa.String(64)),
    sa.Column("artifacts", sa.Text, nullable=False),
    sa.Column("problem", sa.Text),
    sa.Column("idempotency_key", sa.String(64), unique=True),
    sa.Column("fingerprint", sa.String(64)),
    sa.Column("last_event", sa.Integer, nullable=False),
    sa.Index("maquette_jobs_newest", "created_at", "id"),
    sa.Index("maquette_jobs_state", "state"),
)

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

WORKERS = sa.Table(
    "maquette_workers",
    METADATA,
    sa.Column("executor_id", sa.String(64), primary_key=True),
    sa.Column("machine", sa.String(200), nullable=False),
    sa.Column("pid", sa.Integer, nullable=False),
    sa.Column("pid_started", sa.String(32), nullable=False),
    sa.Column("beat", sa.Integer, nullable=False),
    sa.Column("started_at", sa.Double, nullable=False),
)

FACTS = sa.Table(
    "maquette_facts",
    METADATA,
    sa.Column("name", sa.String(64), primary_key=True),
    sa.Column("value", sa.Text, nullable=False),
)
