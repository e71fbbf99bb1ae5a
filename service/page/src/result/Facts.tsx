// How the fit went, what was found, and what had to be assumed.
import { getRequest } from "../api/calls";
import type { FitResult, Job } from "../api/types";
import { termLabel } from "../fit/stages";
import { plainName, wordFor } from "../messages/catalogue";
import { decimal, listed, measured, percent, seconds } from "../messages/figures";
import { messages } from "../messages/language";
import { AssumptionNotes } from "../ui/AssumptionNotes";
import { fromHeight, fromSide } from "../ui/direction";
import { Served } from "../ui/Served";
import { answered } from "../ui/answered";
import { useAsked } from "../ui/asked";
import { gradeInWords, gradeOf } from "./grade";
import { explanationOf, isContradicted } from "./outcome";

/** Of limbs that may slant either way this page tells by itself, with what can be done. */
const OPEN_FACING = "ambiguous-limb-facing";

const NOTHING: Pick<FitResult, "light" | "reflectance"> = { light: null, reflectance: null };

interface Props {
  readonly job: Job;
  readonly result: FitResult;
  /** Say which way these limbs slant; null until the picture is there. */
  readonly onSayWhich: ((limbs: readonly string[]) => void) | null;
}

export function Facts({ job, result, onSayWhich }: Props) {
  const asked = useAsked(job.id, () => getRequest(job));
  const { points, result: words } = messages.value;
  const explained = explanationOf(result) ?? <Served text={result.outcome_explanation} />;
  const { image_camera: camera } = result;
  // Of a body that is not the picture's, light and skin say nothing.
  const { light, reflectance } = isContradicted(result) ? NOTHING : result;
  const mm = (camera.focal_length_px * 43.27) / Math.hypot(camera.width, camera.height);
  const warnings = (result.warnings ?? []).filter((warning) => warning.code !== OPEN_FACING);
  const open = result.limb_facing.filter((limb) => limb.ambiguous);
  return (
    <>
      <p class={`quality is-${gradeOf(result)}`} data-grade={gradeOf(result)}>
        {gradeInWords(result)}
      </p>
      {isContradicted(result) && <p class="note is-problem">{explained}</p>}
      <p class="fine">
        {result.outcome !== "converged" && !isContradicted(result) && <>{explained} </>}
        {words.foundBy[result.cues]}
      </p>
      {warnings.map((warning) => (
        <p class="note" key={warning.code}>
          {answered("warnings", warning.code) ?? <Served text={warning.message} />}
        </p>
      ))}
      {open.length > 0 && (
        <p class="note">
          {words.openFacing(listed(open.map(({ limb, facing }) => words.slants[facing](wordFor(points.limbs, limb) ?? plainName(limb)))))}
          {onSayWhich && " "}
          {onSayWhich && (
            <button class="link" type="button" onClick={() => onSayWhich(open.map(({ limb }) => limb))}>
              {words.sayWhich}
            </button>
          )}
        </p>
      )}
      <AssumptionNotes assumptions={result.assumptions} asked={asked?.points ?? null} />
      <dl class={gradeOf(result) === "poor" ? "facts is-unreliable" : "facts"}>
        <dt>{words.overlap}</dt>
        <dd>{percent(result.silhouette_overlap, 1)}</dd>
        <dt>{words.lens}</dt>
        <dd>
          {words.lensOf(measured(mm, "millimeter"), words.sources[result.focal_length_source])}
        </dd>
        {light && (
          <>
            <dt>{words.light}</dt>
            <dd>{lightWords(light)}</dd>
          </>
        )}
        {reflectance && (
          <>
            <dt>{words.skin}</dt>
            <dd>
              {words.skinOf(percent(reflectance.mean_albedo), percent(reflectance.mean_specularity))}
              {!light?.surroundings && `; ${words.ambient(decimal(reflectance.ambient, 2))}`}
            </dd>
          </>
        )}
      </dl>
      <details class="fold">
        <summary>{words.expert}</summary>
        <dl class="facts">
          {Object.entries(result.energies).map(([name, value]) => (
            <>
              <dt>{termLabel(name)}</dt>
              <dd>{decimal(value, 1)}</dd>
            </>
          ))}
          <dt>{words.evaluations}</dt>
          <dd>{decimal(result.evaluations)}</dd>
          <dt>{words.time}</dt>
          <dd>{seconds(Object.values(result.stage_seconds).reduce((sum, each) => sum + each, 0), 1)}</dd>
        </dl>
      </details>
    </>
  );
}

function lightWords({ kind, azimuth_deg, elevation_deg, distance_m, surroundings }: NonNullable<FitResult["light"]>): string {
  const { result: words } = messages.value;
  const away = kind === "point" && distance_m !== null ? words.lightAway(measured(distance_m, "meter", 1)) : words.lightFar;
  const light = [fromSide(azimuth_deg), fromHeight(elevation_deg), away].join(", ");
  return surroundings ? words.lightAround(light) : light;
}
