// A scan on its way: which picture it is at.
import { useState } from "preact/hooks";
import type { Scan } from "../api/types";
import type { Picture } from "../draft/picture";
import { stageLabel } from "../fit/stages";
import { percent } from "../messages/figures";
import { messages } from "../messages/language";
import { Icon } from "../ui/Icon";

interface Props {
  readonly scan: Scan;
  readonly pictures: readonly Picture[];
  readonly onCancel: () => void;
}

export function ScanProgress({ scan, pictures, onCancel }: Props) {
  const [stopping, setStopping] = useState(scan.cancel_requested);
  const { fit, measure: { progress: words } } = messages.value;
  return (
    <main class="measure is-waiting">
      <h1>{scan.state === "queued" ? words.queued : words.running}</h1>
      <progress class="bar" max={1} value={scan.progress} aria-label={words.label}>
        {percent(scan.progress)}
      </progress>
      <p class="fine" role="status">
        {standing(scan)}
      </p>
      <ul class="scan-pictures">
        {pictures.map(({ url }, number) => (
          <li key={url} class={scan.view === number ? "is-current" : ""}>
            <img src={url} alt={words.picture(number + 1)} />
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
          {stopping ? fit.stopping : fit.cancel}
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
  const { progress: words } = messages.value.measure;
  if (state === "queued") return words.sent;
  if (view === null && !stage) return words.beginning;
  const what = view === null ? words.together : words.alone(view + 1);
  // Reading a picture is a stage called by what it reads.
  return stage && stage !== "observation" ? words.stage(what, stageLabel(stage)) : what;
}
