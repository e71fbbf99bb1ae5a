// Over the picture: the live body's outline, the skeleton, the points.
import { points, selected } from "../draft/draft";
import { liveBody } from "../draft/live";
import { BONES, pointOf, sideOf } from "../points/catalogue";
import type { PointName } from "../points/catalogue";
import { toStage } from "./view";
import type { Size, View } from "./view";

interface Props {
  readonly view: View;
  readonly size: Size;
  readonly dragged: PointName | null;
}

export function ClickLayer({ view, size, dragged }: Props) {
  const { placed } = points.value;
  const at = (name: PointName) => placed[name] && toStage(view, placed[name]);
  return (
    <svg class="click-layer" width={size.width} height={size.height} aria-hidden="true">
      <Outline view={view} />
      {BONES.map(([from, to]) => {
        const [a, b] = [at(from), at(to)];
        if (!a || !b) return null;
        const side = sideOf(from) === sideOf(to) ? sideOf(from) : "middle";
        return (
          <g key={`${from}-${to}`}>
            <line class="bone-rim" x1={a.x} y1={a.y} x2={b.x} y2={b.y} />
            <line class={`bone is-${side}`} x1={a.x} y1={a.y} x2={b.x} y2={b.y} />
          </g>
        );
      })}
      {(Object.keys(placed) as PointName[]).map((name) => {
        const spot = at(name)!;
        const chosen = selected.value === name;
        return (
          <g key={name} transform={`translate(${spot.x} ${spot.y})`} class={`point is-${sideOf(name)}`} data-point={name}>
            {chosen && <circle class="point-halo-rim" r={12} />}
            {chosen && <circle class="point-halo" r={12} />}
            <circle class={`point-dot ${placed[name]!.hidden ? "is-hidden" : ""}`} r={chosen ? 6 : 5} />
            {chosen && dragged === null && (
              <text class="point-label" x={17} y={4}>
                {pointOf(name).label}
              </text>
            )}
          </g>
        );
      })}
    </svg>
  );
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
