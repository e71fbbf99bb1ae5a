// Through which lens: from the picture's own data, chosen by eye, or assumed.
import { focalLength, uploaded } from "../draft/draft";

const SHORTEST_MM = 16;
const LONGEST_MM = 200;
const ASSUMED_MM = 50;
const LENSES: readonly (readonly [number, string])[] = [
  [20, "a very wide lens"],
  [32, "a phone’s main camera"],
  [42, "a slightly wide lens"],
  [60, "a normal lens"],
  [95, "a portrait lens, or a phone’s second camera"],
  [Infinity, "a long lens, far away"],
];

export function LensPanel() {
  const exif = uploaded.value?.focal_length_35mm ?? null;
  const chosen = focalLength.value;
  const shown = chosen ?? exif ?? ASSUMED_MM;
  return (
    <div class="subsection">
      <h3>Lens</h3>
      <p class="fine">
        {chosen !== null
          ? "Chosen by eye."
          : exif !== null
            ? "Read from the picture."
            : uploaded.value
              ? "The picture names none: 50 mm are assumed."
              : "The picture is being read."}
      </p>
      <label class="slider">
        <span class="unseen">Focal length, as on 35 mm film</span>
        <input
          type="range"
          min={Math.log(SHORTEST_MM)}
          max={Math.log(LONGEST_MM)}
          step="any"
          value={Math.log(shown)}
          aria-valuetext={`${shown.toFixed(0)} mm, ${lensOf(shown)}`}
          onInput={(event) => (focalLength.value = Math.round(Math.exp(Number(event.currentTarget.value))))}
        />
        <output>{shown.toFixed(0)} mm</output>
      </label>
      <p class="fine">
        As {lensOf(shown)}. The nearer the camera stood, the shorter: feet look large, or the head does.
        {chosen !== null && (
          <button class="link" type="button" onClick={() => (focalLength.value = null)}>
            {exif !== null ? `Use ${exif.toFixed(0)} mm from the picture` : "Leave it unknown"}
          </button>
        )}
      </p>
    </div>
  );
}

function lensOf(mm: number): string {
  return LENSES.find(([below]) => mm < below)![1];
}
