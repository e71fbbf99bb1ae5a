# Postgres' image runs this once, when its volume is empty: the service gets a role that owns its
# database and has no other rights.
psql --no-psqlrc --quiet --set=ON_ERROR_STOP=1 --username="${POSTGRES_USER:-postgres}" \
  --dbname=postgres --set=password="$ROLE_PASSWORD" <<'SQL'
CREATE ROLE maquette LOGIN NOSUPERUSER NOCREATEDB NOCREATEROLE NOREPLICATION PASSWORD :'password';
CREATE DATABASE maquette OWNER maquette;
REVOKE ALL ON DATABASE maquette FROM PUBLIC;
SQL
