// How the fit went, what was found, and what had to be assumed.
import type { FitResult } from "../api/types";
import { termLabel } from "../fit/stages";
import { AssumptionNotes } from "../ui/AssumptionNotes";
import { isContradicted } from "./outcome";

const SOURCES: Readonly<Record<string, string>> = {
  caller: "as given",
  exif_35mm_equivalent: "from the picture",
  exif_focal_length_and_sensor: "from the picture",
  assumed: "assumed",
};

/** Of limbs that may slant either way this page tells by itself, with what can be done. */
const OPEN_FACING = "ambiguous-limb-facing";

/** The other way than the one found. */
const SLANTS = { toward: "slanting away", away: "slanting toward you" } as const;

interface Props {
  readonly result: FitResult;
  /** Take the fit up again, to say which way limbs slant; null until its picture is there. */
  readonly onChange: (() => void) | null;
}

export function Facts({ result, onChange }: Props) {
  const { light, reflectance, image_camera: camera } = result;
  const mm = (camera.focal_length_px * 43.27) / Math.hypot(camera.width, camera.height);
  const warnings = (result.warnings ?? []).filter((warning) => warning.code !== OPEN_FACING);
  const open = result.limb_facing.filter((limb) => limb.ambiguous);
  return (
    <>
      {isContradicted(result) && <p class="note is-problem">{result.outcome_explanation}</p>}
      <p class="fine">
        {result.outcome !== "converged" && !isContradicted(result) && `${result.outcome_explanation} `}
        Found by {result.cues === "SES" ? "silhouette, edges and shading" : "silhouette and edges"}.
      </p>
      {warnings.map((warning) => (
        <p class="note" key={warning.code}>
          {warning.message.replaceAll("_", " ")}
        </p>
      ))}
      {open.length > 0 && (
        <p class="note">
          The picture fits about as well with the {open.map((limb) => `${limb.limb.replaceAll("_", " ")} ${SLANTS[limb.facing]}`).join(", the ")}.
          {onChange && " "}
          {onChange && (
            <button class="link" type="button" onClick={onChange}>
              If you see which, say so and fit again
            </button>
          )}
        </p>
      )}
      <AssumptionNotes assumptions={result.assumptions} />
      <dl class="facts">
        <dt>Overlap with the silhouette</dt>
        <dd>{(100 * result.silhouette_overlap).toFixed(1)} %</dd>
        <dt>Lens</dt>
        <dd>
          {mm.toFixed(0)} mm, {SOURCES[result.focal_length_source]}
        </dd>
        {light && (
          <>
            <dt>Light</dt>
            <dd>{lightWords(light)}</dd>
          </>
        )}
        {reflectance && (
          <>
            <dt>Skin</dt>
            <dd>
              albedo {reflectance.mean_albedo.toFixed(2)}, gloss {reflectance.mean_specularity.toFixed(2)}
              {!light?.surroundings && `, ambient ${reflectance.ambient.toFixed(2)}`}
            </dd>
          </>
        )}
      </dl>
      <details class="fold">
        <summary>Energies and times</summary>
        <dl class="facts">
          {Object.entries(result.energies).map(([name, value]) => (
            <>
              <dt>{termLabel(name)}</dt>
              <dd>{value.toFixed(1)} nats</dd>
            </>
          ))}
          <dt>Evaluations</dt>
          <dd>{result.evaluations}</dd>
          <dt>Time</dt>
          <dd>{Object.values(result.stage_seconds).reduce((sum, each) => sum + each, 0).toFixed(1)} s</dd>
        </dl>
      </details>
    </>
  );
}

function lightWords({ kind, azimuth_deg, elevation_deg, distance_m, surroundings }: NonNullable<FitResult["light"]>): string {
  const across = `${Math.abs(azimuth_deg).toFixed(0)}° from the ${azimuth_deg > 0 ? "right" : "left"}`;
  const along = `${Math.abs(elevation_deg).toFixed(0)}° from ${elevation_deg > 0 ? "above" : "below"}`;
  const away = kind === "point" && distance_m !== null ? `, ${distance_m.toFixed(1)} m away` : ", far away";
  return `${across}, ${along}${away}${surroundings ? "; and from the surroundings, by direction" : ""}`;
}
