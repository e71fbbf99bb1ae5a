// What happens to a picture, and when it is erased: as this service is set up.
import { signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { getIndex } from "../api/calls";
import { duration } from "../messages/figures";
import { messages } from "../messages";

/** Null until the service has told; the sentence then names no time. */
const retentionHours = signal<number | null>(null);

export function KeptLine() {
  const { kept } = messages.start;
  useEffect(() => {
    if (retentionHours.value !== null) return;
    getIndex().then(
      (index) => (retentionHours.value = index.retention_hours),
      () => undefined,
    );
  }, []);
  const hours = retentionHours.value;
  return (
    <p class="fine start-kept">
      {hours === null ? kept.untold : kept.erased(duration(hours))}
    </p>
  );
}
