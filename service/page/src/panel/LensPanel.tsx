// Through which lens: from the picture's own data, chosen by eye, or assumed.
import { current, focalLength } from "../draft/draft";
import { measured } from "../messages/figures";
import { messages } from "../messages";

const SHORTEST_MM = 16;
const LONGEST_MM = 200;
const ASSUMED_MM = 50;
const LENSES: readonly (readonly [number, keyof typeof messages.panel.lens.kinds])[] = [
  [20, "veryWide"],
  [32, "phone"],
  [42, "wide"],
  [60, "normal"],
  [95, "portrait"],
  [Infinity, "long"],
];

export function LensPanel() {
  const { lens } = messages.panel;
  const uploaded = current.value!.uploaded.value;
  const exif = uploaded?.focal_length_35mm ?? null;
  const chosen = focalLength.value;
  const shown = chosen ?? exif ?? ASSUMED_MM;
  return (
    <div class="subsection">
      <h3>{lens.title}</h3>
      <p class="fine">
        {chosen !== null
          ? lens.chosen
          : exif !== null
            ? lens.fromPicture
            : uploaded
              ? lens.none(measured(ASSUMED_MM, "millimeter"))
              : lens.reading}
      </p>
      <label class="slider">
        <span class="unseen">{lens.label}</span>
        <input
          type="range"
          min={Math.log(SHORTEST_MM)}
          max={Math.log(LONGEST_MM)}
          step="any"
          value={Math.log(shown)}
          aria-valuetext={lens.valued(measured(shown, "millimeter"), lensOf(shown))}
          onInput={(event) => (focalLength.value = Math.round(Math.exp(Number(event.currentTarget.value))))}
        />
        <output>{measured(shown, "millimeter")}</output>
      </label>
      <p class="fine">
        {lens.explained(lensOf(shown))}
        {chosen !== null && (
          <button class="link" type="button" onClick={() => (focalLength.value = null)}>
            {exif !== null ? lens.usePicture(measured(exif, "millimeter")) : lens.leaveUnknown}
          </button>
        )}
      </p>
    </div>
  );
}

function lensOf(mm: number): string {
  return messages.panel.lens.kinds[LENSES.find(([below]) => mm < below)![1]];
}
