// What there is to say of one picture: what is in doubt, and for experts its lens and its light.
import type { FitResult } from "../api/types";
import type { FittedView, Result } from "../api/fits";
import { Findings } from "../measure/Findings";
import { plainName, wordFor } from "../messages/words";
import { decimal, listed, measured, percent } from "../messages/figures";
import { messages } from "../messages";
import { AssumptionNotes } from "../ui/AssumptionNotes";
import { fromHeight, fromSide } from "../ui/direction";
import { PROPOSED_POINTS } from "../ui/proposed";
import type { FactsProps } from "./Facts";
import { WarningNotes } from "./WarningNotes";
import { gradeOf } from "./grade";
import { explanationOf, isContradicted } from "./outcome";

/** Of limbs that may slant either way this page tells by itself, with what can be done. */
const OPEN_FACING = "ambiguous-limb-facing";

const NOTHING: Pick<FittedView, "light" | "reflectance"> = { light: null, reflectance: null };

interface Props extends Pick<FactsProps, "onSayWhich"> {
  readonly view: FittedView;
  readonly views: Result["views"];
  /** The points that were asked for; null while they are not known. */
  readonly asked: unknown;
}

export function OfPicture({ view, views, asked, onSayWhich }: Props) {
  const isOfSeveral = views.length > 1;
  const explained = explanationOf(view, isOfSeveral) ?? view.outcome_explanation;
  // Of several pictures it is said once how many points were proposed in each.
  const assumptions = isOfSeveral ? view.assumptions.filter(({ quantity }) => quantity !== PROPOSED_POINTS) : view.assumptions;
  return (
    <>
      {isContradicted(view) && <p class="note is-problem">{explained}</p>}
      {view.outcome !== "converged" && !isContradicted(view) && <p class="fine">{explained}</p>}
      <Findings findings={view.findings} />
      <WarningNotes warnings={view.warnings.filter(({ code }) => code !== OPEN_FACING)} views={views} />
      <OpenLimbs view={view} onSayWhich={onSayWhich} />
      <AssumptionNotes assumptions={assumptions} asked={asked} />
    </>
  );
}

/** How well the body covers the person, with which lens, in which light and of which skin. */
export function PictureFacts({ view }: Pick<Props, "view">) {
  const { result: words } = messages;
  const { image_camera: camera } = view;
  // Of a body that is not the picture's, light and skin say nothing.
  const { light, reflectance } = isContradicted(view) ? NOTHING : view;
  const mm = (camera.focal_length_px * 43.27) / Math.hypot(camera.width, camera.height);
  const facts = gradeOf(view) === "poor" ? "facts is-unreliable" : "facts";
  return (
    <dl class={facts}>
      <dt>{words.overlap}</dt>
      <dd>{percent(view.silhouette_overlap, 1)}</dd>
      <dt>{words.lens}</dt>
      <dd>{words.lensOf(measured(mm, "millimeter"), words.sources[view.focal_length_source])}</dd>
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
  );
}

/** Whether there is anything to do about a picture, or to know of it before it is believed. */
export function hasNotes({ verdict, outcome, findings, warnings, limb_facing, assumptions }: FittedView): boolean {
  return (
    verdict !== "plausible" ||
    outcome !== "converged" ||
    findings.length + warnings.length > 0 ||
    limb_facing.some(({ ambiguous }) => ambiguous) ||
    assumptions.some(({ quantity }) => quantity !== PROPOSED_POINTS)
  );
}

function OpenLimbs({ view, onSayWhich }: Pick<Props, "view" | "onSayWhich">) {
  const { points, result: words } = messages;
  const open = view.limb_facing.filter(({ ambiguous }) => ambiguous);
  if (open.length === 0) return null;
  return (
    <p class="note">
      {words.openFacing(listed(open.map(({ limb, facing }) => words.slants[facing](wordFor(points.limbs, limb) ?? plainName(limb)))))}
      {onSayWhich && " "}
      {onSayWhich && (
        <button class="link" type="button" onClick={() => onSayWhich(open.map(({ limb }) => limb), view.number)}>
          {words.sayWhich}
        </button>
      )}
    </p>
  );
}

function lightWords({ kind, azimuth_deg, elevation_deg, distance_m, surroundings }: NonNullable<FitResult["light"]>): string {
  const { result: words } = messages;
  const away = kind === "point" && distance_m !== null ? words.lightAway(measured(distance_m, "meter", 1)) : words.lightFar;
  const light = [fromSide(azimuth_deg), fromHeight(elevation_deg), away].join(", ");
  return surroundings ? words.lightAround(light) : light;
}
