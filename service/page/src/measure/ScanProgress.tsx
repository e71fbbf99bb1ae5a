// A scan on its way: which picture it is at.
import { useState } from "preact/hooks";
import type { Scan } from "../api/types";
import type { Picture } from "../draft/picture";
import { stageLabel } from "../fit/stages";
import { Icon } from "../ui/Icon";

interface Props {
  readonly scan: Scan;
  readonly pictures: readonly Picture[];
  readonly onCancel: () => void;
}

export function ScanProgress({ scan, pictures, onCancel }: Props) {
  const [stopping, setStopping] = useState(scan.cancel_requested);
  const percent = Math.round(100 * scan.progress);
  return (
    <main class="measure is-waiting">
      <h1>{scan.state === "queued" ? "Waiting for its turn" : "Measuring"}</h1>
      <progress class="bar" max={100} value={percent} aria-label="Progress of the scan">
        {percent} %
      </progress>
      <p class="fine" role="status">
        {standing(scan)}
      </p>
      <ul class="scan-pictures">
        {pictures.map(({ url }, number) => (
          <li key={url} class={scan.view === number ? "is-current" : ""}>
            <img src={url} alt={`Picture ${number + 1}`} />
            {isDone(scan, number) && <Icon name="check" />}
          </li>
        ))}
      </ul>
      <div class="submit">
        <button
          class="button is-wide"
          type="button"
          disabled={stopping}
          onClick={() => {
            setStopping(true);
            onCancel();
          }}
        >
          {stopping ? "Stopping …" : "Cancel"}
        </button>
      </div>
    </main>
  );
}

/** Pictures are searched one after the other, before all together. */
function isDone({ view, stage, progress }: Scan, number: number): boolean {
  return view === null ? stage !== null && progress > 0.5 : number < view;
}

function standing({ view, stage, state }: Scan): string {
  if (state === "queued") return "The pictures are with the service.";
  const what = stage ? `: ${stageLabel(stage).toLowerCase()}` : "";
  if (view === null) return stage ? `Both pictures together${what}` : "Beginning …";
  return `Picture ${view + 1} by itself${what}`;
}
