// Points read from a file, and kept in one.
import { useSignal } from "@preact/signals";
import { change, picture, points, selected } from "../draft/draft";
import { messages } from "../messages";
import { cocoFile, readPoints } from "../points/coco";
import { NO_POINTS } from "../points/placed";
import { saveFile } from "../ui/save";

export function PointFiles() {
  const { points: words } = messages.panel;
  const fault = useSignal<string | null>(null);
  const count = Object.keys(points.value.placed).length;
  return (
    <details class="fold">
      <summary>{words.files}</summary>
      <div class="row">
        <label class="button is-small">
          {words.read}
          <input
            class="unseen"
            type="file"
            accept=".json,application/json"
            aria-label={words.readLabel}
            onChange={async (event) => {
              const input = event.currentTarget;
              const file = input.files?.[0];
              if (!file) return;
              try {
                change(readPoints(await file.text()));
                selected.value = null;
                fault.value = null;
              } catch (error) {
                fault.value = (error as Error).message;
              }
              input.value = "";
            }}
          />
        </label>
        <button
          class="button is-small"
          type="button"
          disabled={count === 0}
          onClick={() => saveFile("points.json", new Blob([cocoFile(points.value, picture.value!)], { type: "application/json" }))}
        >
          {words.save}
        </button>
        <button
          class="button is-small"
          type="button"
          disabled={count === 0}
          onClick={() => {
            change(NO_POINTS);
            selected.value = null;
          }}
        >
          {words.clear}
        </button>
      </div>
      <p class="fine">{words.filesNote}</p>
      {fault.value && (
        <p class="note is-problem" role="alert">
          {fault.value}
        </p>
      )}
    </details>
  );
}
