// How the fit went, what was found, and what had to be assumed.
import type { FitResult } from "../api/types";
import { termLabel } from "../fit/stages";
import { AssumptionNotes } from "../ui/AssumptionNotes";

const SOURCES: Readonly<Record<string, string>> = {
  caller: "as given",
  exif_35mm_equivalent: "from the picture",
  exif_focal_length_and_sensor: "from the picture",
  assumed: "assumed",
};

/** How the service tells programs what people choose on this page. */
const ASK_THE_CALLER = "Say which in limb_facing.";

export function Facts({ result }: { result: FitResult }) {
  const { light, reflectance, image_camera: camera } = result;
  const mm = (camera.focal_length_px * 43.27) / Math.hypot(camera.width, camera.height);
  const warnings = result.warnings ?? [];
  return (
    <>
      <p class="fine">
        {result.outcome_explanation} {result.cues === "SES" ? "Silhouette, edges and shading." : "Silhouette and edges."}
      </p>
      {warnings.map((warning) => (
        <p class="note" key={warning.code}>
          {warning.message.replace(ASK_THE_CALLER, "If you see it, change the fit and say so.").replaceAll("_", " ")}
        </p>
      ))}
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
              albedo {reflectance.mean_albedo.toFixed(2)}, gloss {reflectance.mean_specularity.toFixed(2)}, ambient{" "}
              {reflectance.ambient.toFixed(2)}
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

function lightWords({ kind, azimuth_deg, elevation_deg, distance_m }: NonNullable<FitResult["light"]>): string {
  const across = `${Math.abs(azimuth_deg).toFixed(0)}° from the ${azimuth_deg > 0 ? "right" : "left"}`;
  const along = `${Math.abs(elevation_deg).toFixed(0)}° from ${elevation_deg > 0 ? "above" : "below"}`;
  const away = kind === "point" && distance_m !== null ? `, ${distance_m.toFixed(1)} m away` : ", far away";
  return `${across}, ${along}${away}`;
}
