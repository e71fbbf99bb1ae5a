// Over the picture: the live body's outline, the skeleton, the points.
import { doubted, points, selected } from "../draft/draft";
import { liveBody } from "../draft/live";
import { messages } from "../messages";
import { BONES, sideOf } from "../points/catalogue";
import type { PointName } from "../points/catalogue";
import { toStage } from "./view";
import type { Size, Spot, View } from "./view";

const RING_PX = 6;
/** Room for a label beside its point. */
const LABEL_PX = 165;

interface Props {
  readonly view: View;
  readonly size: Size;
  readonly dragged: PointName | null;
}

export function ClickLayer({ view, size, dragged }: Props) {
  const { points: words, stage } = messages;
  const { placed } = points.value;
  const at = (name: PointName) => placed[name] && toStage(view, placed[name]);
  return (
    <svg class="click-layer" width={size.width} height={size.height} aria-hidden="true">
      <Outline view={view} />
      {BONES.map(([from, to]) => {
        const [first, last] = [at(from), at(to)];
        if (!first || !last) return null;
        const a = placed[from]!.proposed ? cut(first, last) : first;
        const b = placed[to]!.proposed ? cut(last, first) : last;
        const side = sideOf(from) === sideOf(to) ? sideOf(from) : "middle";
        const isProposed = placed[from]!.proposed || placed[to]!.proposed;
        return (
          <g key={`${from}-${to}`} class={isProposed ? "is-proposed" : ""}>
            <line class="bone-rim" x1={a.x} y1={a.y} x2={b.x} y2={b.y} />
            <line class={`bone is-${side}`} x1={a.x} y1={a.y} x2={b.x} y2={b.y} />
          </g>
        );
      })}
      {(Object.keys(placed) as PointName[]).map((name) => {
        const spot = at(name)!;
        const where = placed[name]!;
        const chosen = selected.value === name;
        const isAsked = selected.value === null && doubted.value === name;
        const isLabelled = (chosen || isAsked) && dragged === null;
        return (
          <g key={name} transform={`translate(${spot.x} ${spot.y})`} class={`point is-${sideOf(name)}`} data-point={name}>
            {(chosen || isAsked) && <circle class="point-halo-rim" r={12} />}
            {(chosen || isAsked) && <circle class={`point-halo ${isAsked ? "is-asked" : ""}`} r={12} />}
            {where.proposed && <circle class="point-ring-rim" r={RING_PX} />}
            <circle
              class={`point-dot ${where.hidden ? "is-hidden" : ""} ${where.proposed ? "is-proposed" : ""}`}
              r={chosen || where.proposed ? RING_PX : 5}
            />
            {isLabelled && (
              <text class={`point-label ${spot.x > size.width - LABEL_PX ? "is-left-of" : ""}`} y={4}>
                {isAsked ? stage.asked(words.labels[name]) : words.labels[name]}
              </text>
            )}
          </g>
        );
      })}
    </svg>
  );
}

/** Where a bone that begins here meets the ring: what lies within is seen. */
function cut(from: Spot, to: Spot): Spot {
  const length = Math.hypot(to.x - from.x, to.y - from.y);
  const share = length > 2 * RING_PX ? RING_PX / length : 0;
  return { x: from.x + share * (to.x - from.x), y: from.y + share * (to.y - from.y) };
}

function Outline({ view }: { view: View }) {
  const body = liveBody.value;
  if (!body) return null;
  const path = body.outline.map((loop) => `M${loop.map(([x, y]) => `${x} ${y}`).join("L")}Z`).join("");
  return (
    <g transform={`translate(${view.x} ${view.y}) scale(${view.scale})`}>
      <path class="live-outline-rim" d={path} vector-effect="non-scaling-stroke" />
      <path class="live-outline" d={path} fill-rule="evenodd" vector-effect="non-scaling-stroke" />
    </g>
  );
}
