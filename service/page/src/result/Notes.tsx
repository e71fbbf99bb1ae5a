// What is in doubt, what to do about it, and what had to be assumed; for experts, how the fit went.
import type { FitResult, Remark, ViewResult } from "../api/types";
import { viewTitles } from "../messages/viewNames";
import { decimal, degrees, listed, measured, percent, seconds } from "../messages/figures";
import { plainName, wordFor } from "../messages/words";
import { messages } from "../messages";
import { AssumptionNotes } from "../ui/AssumptionNotes";
import { Findings } from "../ui/Findings";
import { remarked } from "../ui/answered";
import { contradictionOf } from "./quality";

/** Of limbs that may slant either way this page tells by itself, with what can be done. */
const OPEN_FACING = "ambiguous-limb-facing";

interface Props {
  readonly result: FitResult;
  /** Say which way these limbs slant in a picture; null until it is there. */
  readonly onSayWhich: ((limbs: readonly string[], number: number) => void) | null;
  /** Correct what was said of a picture; null until it is there. */
  readonly onCorrect: ((number: number) => void) | null;
}

export function Notes({ result, onSayWhich, onCorrect }: Props) {
  const { views, warnings, assumptions } = result;
  const contradiction = contradictionOf(result);
  return (
    <>
      <div class="section notes">
        {contradiction && <p class="note is-problem">{contradiction}</p>}
        <WarningNotes warnings={warnings} views={views} />
        {views.length === 1 && <OfPicture view={views[0]!} number={0} result={result} onSayWhich={onSayWhich} />}
        <AssumptionNotes assumptions={assumptions} heightM={result.height_m} lensMm={lensMm(views[0]!)} />
      </div>
      {views.length > 1 &&
        views.map((view, number) => (
          <details class="section fold-section" key={number} open={hasNotes(view)} data-view={number}>
            <summary>
              <h2>{viewTitles(views)[number]}</h2>
            </summary>
            <div class="of-picture">
              <OfPicture view={view} number={number} result={result} onSayWhich={onSayWhich} />
              {onCorrect && (
                <button class="button is-small" type="button" onClick={() => onCorrect(number)}>
                  {messages.result.correct}
                </button>
              )}
            </div>
          </details>
        ))}
    </>
  );
}

interface PictureProps extends Pick<Props, "onSayWhich"> {
  readonly view: ViewResult;
  readonly number: number;
  readonly result: FitResult;
}

function OfPicture({ view, number, result, onSayWhich }: PictureProps) {
  const { findings, warnings, assumptions, outcome } = view;
  const explained = wordFor(messages.result.explained, outcome);
  const found = new Set(findings.map(({ code }) => code));
  return (
    <>
      {explained && <p class="fine">{explained}</p>}
      <Findings findings={findings} />
      <WarningNotes warnings={warnings.filter(({ code }) => code !== OPEN_FACING && !found.has(code))} views={result.views} />
      <OpenLimbs view={view} number={number} onSayWhich={onSayWhich} />
      <AssumptionNotes assumptions={assumptions} heightM={result.height_m} lensMm={lensMm(view)} />
    </>
  );
}

function WarningNotes({ warnings, views }: { warnings: readonly Remark[]; views: FitResult["views"] }) {
  return (
    <>
      {warnings.map((remark) => (
        <p class="note" key={remark.code + remark.reason}>
          {withTitles(remarked(remark), views)}
        </p>
      ))}
    </>
  );
}

/** A message of the service with its pictures as people call them: `views.1` is the side picture. */
function withTitles(message: string, views: FitResult["views"]): string {
  const titles = viewTitles(views);
  return message.replace(/\bviews\.(\d+)\b/g, (whole, number: string) => titles[Number(number)] ?? whole);
}

/** Whether there is anything to do about a picture, or to know of it before it is believed. */
function hasNotes({ verdict, outcome, findings, warnings, limb_facing }: ViewResult): boolean {
  return verdict !== "plausible" || outcome !== "converged" || findings.length + warnings.length > 0 || limb_facing.some(({ ambiguous }) => ambiguous);
}

function OpenLimbs({ view, number, onSayWhich }: Omit<PictureProps, "result">) {
  const { points, result: words } = messages;
  const open = view.limb_facing.filter(({ ambiguous }) => ambiguous);
  if (open.length === 0) return null;
  return (
    <p class="note">
      {words.openFacing(listed(open.map(({ limb, facing }) => words.slants[facing](wordFor(points.limbs, limb) ?? plainName(limb)))))}
      {onSayWhich && " "}
      {onSayWhich && (
        <button class="link" type="button" onClick={() => onSayWhich(open.map(({ limb }) => limb), number)}>
          {words.sayWhich}
        </button>
      )}
    </p>
  );
}

export function ForExperts({ result }: Pick<Props, "result">) {
  const { agreement, cues, energies, evaluations, stage_seconds, views } = result;
  const { result: words } = messages;
  const titles = viewTitles(views);
  return (
    <details class="section fold-section experts">
      <summary>
        <h2>{words.expert}</h2>
      </summary>
      <p class="fine">{words.foundBy[cues]}</p>
      {agreement !== null && <p class="fine">{words.agreement(percent(agreement, agreement < 0.01 ? 1 : 0))}</p>}
      {views.map((view, number) => (
        <>
          {views.length > 1 && <h3>{titles[number]}</h3>}
          <PictureFacts view={view} />
        </>
      ))}
      <dl class="facts">
        {Object.entries(energies).map(([name, value]) => (
          <>
            <dt>{plainName(name)}</dt>
            <dd>{decimal(value, 1)}</dd>
          </>
        ))}
        <dt>{words.evaluations}</dt>
        <dd>{decimal(evaluations)}</dd>
        <dt>{words.time}</dt>
        <dd>{seconds(Object.values(stage_seconds).reduce((sum, each) => sum + each, 0), 1)}</dd>
      </dl>
    </details>
  );
}

/** How well the body covers the person, with which lens, in which light and of which skin. */
function PictureFacts({ view }: { view: ViewResult }) {
  const { result: words } = messages;
  const { light, reflectance } = view;
  return (
    <dl class="facts">
      <dt>{words.overlap}</dt>
      <dd>{percent(view.silhouette_overlap, 1)}</dd>
      <dt>{words.lens}</dt>
      <dd>{words.lensOf(measured(lensMm(view), "millimeter"), words.sources[view.focal_length_source])}</dd>
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
            {words.skinOf(percent(reflectance.mean_albedo), percent(reflectance.mean_specularity))}; {words.ambient(decimal(reflectance.ambient, 2))}
          </dd>
        </>
      )}
    </dl>
  );
}

/** The focal length as on 35 mm film. */
function lensMm({ image_camera: camera }: ViewResult): number {
  return (camera.focal_length_px * 43.27) / Math.hypot(camera.width, camera.height);
}

function lightWords(light: NonNullable<ViewResult["light"]>): string {
  const { result: words } = messages;
  const [azimuth, elevation, distance] = [light.azimuth_deg ?? 0, light.elevation_deg ?? 0, light.distance_m ?? null];
  const side = azimuth > 0 ? words.fromRight : words.fromLeft;
  const height = elevation > 0 ? words.fromAbove : words.fromBelow;
  const away = distance === null ? words.lightFar : words.lightAway(measured(distance, "meter", 1));
  return [side(degrees(Math.abs(azimuth))), height(degrees(Math.abs(elevation))), away].join(", ");
}
