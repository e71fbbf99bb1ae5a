// Which point comes next, what it means, and what can be done with those there are.
import { useSignal } from "@preact/signals";
import { change, doubted, picture, points, seenFromBehind, selected, timeline, todo, upcoming } from "../draft/draft";
import { liveBody, liveProblem } from "../draft/live";
import { POINTS, pointOf, sideOf } from "../points/catalogue";
import type { PointName } from "../points/catalogue";
import { cocoFile, readPoints } from "../points/coco";
import { NO_POINTS, ask, leave, missing, remove, skip, skipRest, swapSides, toggleHidden } from "../points/placed";
import type { Place, Points } from "../points/placed";
import { countProposed, hasProposed, isAllProposed } from "../points/proposed";
import { redo, undo } from "../points/timeline";
import { IconButton } from "../ui/IconButton";
import { ProblemNote } from "../ui/ProblemNote";
import { saveFile } from "../ui/save";
import { DoubtAnswers, DoubtCloseUp, DoubtQuestion, questionOf } from "./DoubtQuestion";
import { Guide } from "./Guide";
import { ClickAll, ProposalNote, ProposalWarnings } from "./ProposalNote";
import { SideNote } from "./SideNote";

const FAR_OFF_SHARE = 0.03;

export function PointsPanel() {
  const next = upcoming.value;
  const doubt = doubted.value;
  // What is wrong with all of them comes before the questions about each.
  const isProposed = isAllProposed(points.value);
  const count = Object.keys(points.value.placed).length;
  return (
    <section class="section" aria-labelledby="points-title">
      <header class="section-head">
        <h2 id="points-title">Points</h2>
        <span class="count">{inAll(points.value)}</span>
        <IconButton icon="undo" label="Undo" disabled={timeline.value.past.length === 0} onClick={() => (timeline.value = undo(timeline.value))} />
        <IconButton icon="redo" label="Redo" disabled={timeline.value.future.length === 0} onClick={() => (timeline.value = redo(timeline.value))} />
        <IconButton icon="swap" label="Swap left and right" disabled={count === 0} onClick={() => change(swapSides(points.value))} />
      </header>
      <ProposalNote />
      {isProposed && <SideNote />}
      <div class="next">
        {doubt ? <DoubtCloseUp name={doubt} /> : <Guide next={next} points={points.value} />}
        <div class="next-text">
          {next ? <Next name={next} /> : doubt ? <DoubtQuestion name={doubt} /> : <Complete />}
        </div>
      </div>
      <ProposalWarnings />
      {!isProposed && <SideNote />}
      {liveProblem.value && <ProblemNote problem={liveProblem.value} />}
      <Doubts />
      <PointList />
      <Files />
      <Ways />
    </section>
  );
}

function inAll(all: Points): string {
  const count = Object.keys(all.placed).length;
  const proposed = countProposed(all);
  if (proposed === 0) return `${count} placed`;
  return proposed === count ? `${count} proposed` : `${proposed} of ${count} proposed`;
}

function Next({ name }: { name: PointName }) {
  const side = sideOf(name);
  const { limbs, trunk } = missing(points.value);
  const isMoved = points.value.placed[name] !== undefined;
  return (
    <>
      <p class="next-kicker">{isMoved ? "Click where it is" : "Click next"}</p>
      <p class={`next-name is-${side}`}>{pointOf(name).label}</p>
      <p class="next-help">{pointOf(name).help}</p>
      {side !== "middle" && (
        <p class="fine">{whichSide(side)}</p>
      )}
      {!isMoved && <p class="fine">{needed(limbs, trunk)}</p>}
      <div class="row">
        <button class="button is-small" type="button" onClick={() => change(skip(points.value, name))}>
          {isMoved ? "Leave out" : "Skip"}
        </button>
        {isMoved && (
          <button class="button is-small" type="button" onClick={() => change(leave(points.value))}>
            Leave it there
          </button>
        )}
        {!isMoved && limbs === 0 && trunk === 0 && (
          <button class="button is-small" type="button" onClick={() => change(skipRest(points.value))}>
            That is enough
          </button>
        )}
      </div>
    </>
  );
}

function whichSide(side: "left" | "right"): string {
  if (seenFromBehind.value) return `The person’s own ${side}, which is yours too: you see their back.`;
  return `The person’s own ${side}: the picture’s ${side === "left" ? "right" : "left"} if they face you.`;
}

/** The next point in two lines above the picture, where the panel is out of sight: on phones. */
export function NextLine() {
  if (doubted.value) return <DoubtLine name={doubted.value} />;
  const name = upcoming.value;
  if (!name && hasProposed(points.value)) return <ProposedLine />;
  const side = name && sideOf(name);
  return (
    <p class={`next-line ${side ? `is-${side}` : ""}`} aria-hidden="true">
      <b>{name ? pointOf(name).label : "All points done"}</b>
      {name && points.value.placed[name] && "Tap where it is. "}
      {name && pointOf(name).help}
      {side && side !== "middle" && <span>{whichSide(side)}</span>}
    </p>
  );
}

/** The question over the picture. */
function DoubtLine({ name }: { name: PointName }) {
  return (
    <div class={`next-line is-doubt is-${sideOf(name)}`}>
      <b>{questionOf(name)}</b>
      <ClickAll kind="link" />
      <DoubtAnswers name={name} />
    </div>
  );
}

function ProposedLine() {
  return (
    <div class="next-line">
      <ClickAll kind="link" />
      <b>Points proposed</b>
      <span>Drag what lies wrong, then fit the body.</span>
    </div>
  );
}

function needed(limbs: number, trunk: number): string {
  if (limbs === 0 && trunk === 0) return "There are enough; more make the body better.";
  if (limbs === 0) return `${trunk} more of the shoulders and hips needed.`;
  return `${limbs} more needed. Guess what is covered, skip what is outside the picture.`;
}

function Complete() {
  const proposed = hasProposed(points.value);
  return (
    <>
      <p class="next-kicker">Points</p>
      <p class="next-name">{proposed ? "Proposed" : "All done"}</p>
      <p class="next-help">
        {proposed ? "Do the points lie on the person’s joints? Left is the person’s own left." : "Does the outline lie on the person?"}{" "}
        Drag a point to move it, or choose one below. Then fit the body.
      </p>
    </>
  );
}

/** Points that lie far from where the body can have them. */
function Doubts() {
  const body = liveBody.value;
  const shown = picture.value;
  if (!body && todo.value === null && !liveProblem.value) return <p class="fine">The body follows in a moment.</p>;
  if (!body || !shown) return null;
  const limit = FAR_OFF_SHARE * Math.hypot(shown.width, shown.height);
  const far = (Object.entries(body.residual_px) as [PointName, number][]).filter(([, pixels]) => pixels > limit);
  const warnings = body.warnings ?? [];
  if (far.length === 0 && warnings.length === 0) return null;
  return (
    <div class="note" role="status">
      {warnings.map((warning) => (
        <p key={warning.code}>{warning.message}</p>
      ))}
      {far.length > 0 && (
        <p>
          No body reaches {far.map(([name]) => pointOf(name).label.toLowerCase()).join(", ")}. Look whether they are where
          they should be, and on the right side.
        </p>
      )}
    </div>
  );
}

function PointList() {
  return (
    <details class="fold">
      <summary>All points</summary>
      <ul class="point-list">
        {POINTS.map(({ name, label }) => {
          const where = points.value.placed[name];
          const skipped = points.value.skipped.includes(name);
          const state = where ? stateOf(where) : skipped ? "skipped" : "open";
          return (
            <li key={name} class={selected.value === name ? "is-selected" : ""}>
              <button
                type="button"
                class={`point-name is-${sideOf(name)}`}
                aria-pressed={selected.value === name}
                onClick={() => {
                  if (where) selected.value = selected.value === name ? null : name;
                  else change(ask(points.value, name));
                }}
              >
                <i class={`dot is-${state}`} />
                {label}
                <small>{state === "open" ? "" : state}</small>
              </button>
              {where && (
                <>
                  <IconButton icon="hidden" label={`${label} is hidden behind something`} pressed={where.hidden} onClick={() => change(toggleHidden(points.value, name))} />
                  <IconButton icon="trash" label={`Remove ${label}`} onClick={() => change(remove(points.value, name))} />
                </>
              )}
              {!where && !skipped && <IconButton icon="skip" label={`Skip ${label}`} onClick={() => change(skip(points.value, name))} />}
            </li>
          );
        })}
      </ul>
    </details>
  );
}

function stateOf({ hidden, proposed }: Place): string {
  if (hidden) return "hidden";
  return proposed ? "proposed" : "placed";
}

function Files() {
  const fault = useSignal<string | null>(null);
  const count = Object.keys(points.value.placed).length;
  return (
    <details class="fold">
      <summary>Points from and to files</summary>
      <div class="row">
        <label class="button is-small">
          Read points
          <input
            class="unseen"
            type="file"
            accept=".json,application/json"
            aria-label="Read points from a COCO JSON file"
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
          Save as COCO
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
          Clear
        </button>
      </div>
      <p class="fine">COCO keypoints (17), or points by name as the API takes them, in pixels of the picture.</p>
      {fault.value && (
        <p class="note is-problem" role="alert">
          {fault.value}
        </p>
      )}
    </details>
  );
}


const WAYS: readonly (readonly [string, string])[] = [
  ["Wheel, pinch, + and −", "come nearer"],
  ["Drag the picture, or its middle button", "move it"],
  ["Drag a point, or arrow keys", "move a point; Shift by ten pixels"],
  ["H", "it is hidden behind something"],
  ["S", "skip the next point"],
  ["Delete", "remove a point"],
  ["Enter", "place the next point at the crosshair the arrow keys move"],
  ["Control Z", "take back"],
];

/** What a mouse, fingers and keys do on the picture. */
function Ways() {
  return (
    <details class="fold">
      <summary>Keys and gestures</summary>
      <dl class="ways">
        {WAYS.map(([way, what]) => (
          <>
            <dt>{way}</dt>
            <dd>{what}</dd>
          </>
        ))}
      </dl>
    </details>
  );
}
