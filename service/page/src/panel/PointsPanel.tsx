// Which point comes next, what it means, and what can be done with those there are.
import { change, current, doubted, person, points, selected, timeline, todo, upcoming } from "../draft/draft";
import { liveBody, liveProblem } from "../draft/live";
import { listed } from "../messages/figures";
import { messages } from "../messages";
import { POINT_NAMES, sideOf } from "../points/catalogue";
import type { PointName } from "../points/catalogue";
import { ask, leave, missing, remove, skip, skipRest, swapSides, toggleHidden } from "../points/placed";
import type { Place, Points } from "../points/placed";
import { countProposed, hasProposed } from "../points/proposed";
import { redo, undo } from "../points/timeline";
import { IconButton } from "../ui/IconButton";
import { remarked } from "../ui/answered";
import { DoubtAnswers, DoubtCloseUp, DoubtQuestion, questionOf } from "./DoubtQuestion";
import { Guide } from "./Guide";
import { ClickAll, ProposalNote, ProposalWarnings } from "./ProposalNote";
import { Ways } from "./Ways";

const FAR_OFF_SHARE = 0.03;

export function PointsPanel() {
  const { points: words } = messages.panel;
  const next = upcoming.value;
  const doubt = doubted.value;
  const count = Object.keys(points.value.placed).length;
  return (
    <section class="section" aria-labelledby="points-title">
      <header class="section-head">
        <h2 id="points-title">{words.title}</h2>
        <span class="count">{inAll(points.value)}</span>
        <IconButton icon="undo" label={words.undo} disabled={timeline.value.past.length === 0} onClick={() => (timeline.value = undo(timeline.value))} />
        <IconButton icon="redo" label={words.redo} disabled={timeline.value.future.length === 0} onClick={() => (timeline.value = redo(timeline.value))} />
        <IconButton icon="swap" label={words.swap} disabled={count === 0} onClick={() => change(swapSides(points.value))} />
      </header>
      <ProposalNote />
      <div class="next">
        {doubt ? <DoubtCloseUp name={doubt} /> : <Guide next={next} points={points.value} />}
        <div class="next-text">
          {next ? <Next name={next} /> : doubt ? <DoubtQuestion name={doubt} /> : <Complete />}
        </div>
      </div>
      <ProposalWarnings />
      <Doubts />
      <PointList />
      <Ways />
    </section>
  );
}

function inAll(all: Points): string {
  const count = Object.keys(all.placed).length;
  const proposed = countProposed(all);
  const { points: words } = messages.panel;
  if (proposed === 0) return words.placed(count);
  return proposed === count ? words.proposed(count) : words.someProposed(proposed, count);
}

function Next({ name }: { name: PointName }) {
  const { panel, points: named } = messages;
  const words = panel.points;
  const side = sideOf(name);
  const { limbs, trunk } = missing(points.value);
  const isMoved = points.value.placed[name] !== undefined;
  return (
    <>
      <p class="next-kicker">{isMoved ? words.clickWhere : words.next}</p>
      <p class={`next-name is-${side}`}>{named.labels[name]}</p>
      <p class="next-help">{named.helps[name]}</p>
      {side !== "middle" && <p class="fine">{words.own[side]}</p>}
      {!isMoved && <p class="fine">{needed(limbs, trunk)}</p>}
      <div class="row">
        <button class="button is-small" type="button" onClick={() => change(skip(points.value, name))}>
          {isMoved ? words.leaveOut : words.skip}
        </button>
        {isMoved && (
          <button class="button is-small" type="button" onClick={() => change(leave(points.value))}>
            {words.leaveThere}
          </button>
        )}
        {!isMoved && limbs === 0 && trunk === 0 && (
          <button class="button is-small" type="button" onClick={() => change(skipRest(points.value))}>
            {words.enough}
          </button>
        )}
      </div>
    </>
  );
}

/** The next point in a few lines above the picture, where the panel is out of sight: on phones. */
export function NextLine() {
  if (doubted.value) return <DoubtLine name={doubted.value} />;
  const name = upcoming.value;
  if (!name && hasProposed(points.value)) return <ProposedLine />;
  if (!name) return <DoneLine />;
  const side = sideOf(name);
  const { panel, points: named } = messages;
  return (
    <div class={`next-line is-guided is-${side}`} aria-hidden="true">
      <Guide next={name} points={points.value} />
      <p>
        <b>{named.labels[name]}</b>
        {points.value.placed[name] && `${panel.points.tapWhere} `}
        {named.helps[name]}
        {side !== "middle" && <span>{panel.points.own[side]}</span>}
      </p>
    </div>
  );
}

function DoneLine() {
  return (
    <div class="next-line">
      <b>{messages.panel.points.allDone}</b> {person.value.gender === null && messages.panel.points.outlineNeedsBody}
    </div>
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
  const { points: words } = messages.panel;
  return (
    <div class="next-line">
      <ClickAll kind="link" />
      <b>{words.pointsProposed}</b>
      <span>{person.value.gender === null ? words.outlineNeedsBody : words.dragThenFit}</span>
    </div>
  );
}

function needed(limbs: number, trunk: number): string {
  const { points: words } = messages.panel;
  if (limbs === 0 && trunk === 0) return words.plenty;
  return limbs === 0 ? words.trunkNeeded(trunk) : words.needed(limbs);
}

function Complete() {
  const { points: words } = messages.panel;
  const proposed = hasProposed(points.value);
  const isDrawn = person.value.gender !== null;
  return (
    <>
      <p class="next-kicker">{words.title}</p>
      <p class="next-name">{proposed ? words.doneProposed : words.done}</p>
      {(proposed || isDrawn) && <p class="next-help">{proposed ? words.lookProposed : words.lookDone}</p>}
      {!isDrawn && <p class="next-help">{words.outlineNeedsBody}</p>}
    </>
  );
}

/** Points that lie far from where the body can have them. */
function Doubts() {
  const { panel, points: named } = messages;
  const body = liveBody.value;
  const shown = current.value?.picture;
  if (!body && todo.value === null && !liveProblem.value) return <p class="fine">{panel.points.bodyFollows}</p>;
  if (!body || !shown) return null;
  const limit = FAR_OFF_SHARE * Math.hypot(shown.width, shown.height);
  const far = (Object.entries(body.residual_px) as [PointName, number][]).filter(([, pixels]) => pixels > limit);
  const warnings = body.warnings ?? [];
  if (far.length === 0 && warnings.length === 0) return null;
  return (
    <div class="note" role="status">
      {warnings.map((warning) => (
        <p key={warning.code}>{remarked(warning)}</p>
      ))}
      {far.length > 0 && (
        <p>{panel.points.unreached(listed(far.map(([name]) => named.named[name])))}</p>
      )}
    </div>
  );
}

function PointList() {
  const { panel, points: named } = messages;
  const words = panel.points;
  return (
    <details class="fold">
      <summary>{words.all}</summary>
      <ul class="point-list">
        {POINT_NAMES.map((name) => {
          const label = named.labels[name];
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
                <small>{words.states[state]}</small>
              </button>
              {where && (
                <>
                  <IconButton icon="hidden" label={words.isHidden(label)} pressed={where.hidden} onClick={() => change(toggleHidden(points.value, name))} />
                  <IconButton icon="trash" label={words.remove(label)} onClick={() => change(remove(points.value, name))} />
                </>
              )}
              {!where && !skipped && <IconButton icon="skip" label={words.skipThis(label)} onClick={() => change(skip(points.value, name))} />}
            </li>
          );
        })}
      </ul>
    </details>
  );
}

function stateOf({ hidden, proposed }: Place): "hidden" | "placed" | "proposed" {
  if (hidden) return "hidden";
  return proposed ? "proposed" : "placed";
}
