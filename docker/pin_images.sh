#!/bin/sh
# Write the digest of today behind every name in images.env: NAME:TAG becomes NAME:TAG@sha256:...
# Look at what changed (git diff), build, test, and commit it.
set -eu
cd "$(dirname "$0")"
pinned=$(mktemp)
trap 'rm -f "$pinned"' EXIT
while IFS= read -r line; do
  case "$line" in
    '#'* | '') printf '%s\n' "$line" ;;
    *)
      image=${line#*=}
      image=${image%@*}
      digest=$(docker buildx imagetools inspect "$image" --format '{{.Manifest.Digest}}' </dev/null)
      case "$digest" in
        sha256:*) printf '%s=%s@%s\n' "${line%%=*}" "$image" "$digest" ;;
        *) echo "pin_images.sh: no digest was told for $image" >&2; exit 1 ;;
      esac
      ;;
  esac
done < images.env > "$pinned"
cat "$pinned" > images.env
