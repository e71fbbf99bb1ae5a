// Who was found, where another one may be meant: a tap on the picture chooses.
import { points } from "../draft/draft";
import { others } from "../draft/proposing";
import { toStage } from "./view";
import type { Size, View } from "./view";

export function PersonBoxes({ view, size }: { view: View; size: Size }) {
  return (
    <svg class="click-layer" width={size.width} height={size.height} aria-hidden="true">
      {others.value.map(([left, top, right, bottom], i) => {
        const from = toStage(view, { x: left, y: top });
        const to = toStage(view, { x: right, y: bottom });
        const box = { x: from.x, y: from.y, width: to.x - from.x, height: to.y - from.y, rx: 6 };
        return (
          <g key={i} class={`person-box ${i === points.value.person ? "is-chosen" : ""}`} data-person={i}>
            <rect class="person-rim" {...box} />
            <rect class="person-line" {...box} />
            <text x={from.x + 9} y={from.y + 19}>
              {i + 1}
            </text>
          </g>
        );
      })}
    </svg>
  );
}
