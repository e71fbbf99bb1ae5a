// A small figure that shows which point is meant. It faces the viewer: its left is on the right.
import { sideOf } from "../points/catalogue";
import type { PointName } from "../points/catalogue";
import type { Points } from "../points/placed";

const RIGHT: Readonly<Partial<Record<PointName, readonly [number, number]>>> = {
  right_shoulder: [44, 58],
  right_elbow: [34, 88],
  right_wrist: [27, 117],
  right_hip: [52, 116],
  right_knee: [50, 158],
  right_ankle: [48, 198],
  right_heel: [49, 206],
  right_toe: [42, 212],
  right_eye: [57, 26],
  right_ear: [50, 29],
};
const MIDDLE: Readonly<Partial<Record<PointName, readonly [number, number]>>> = {
  nose: [62, 31],
  head_top: [62, 12],
  chin: [62, 41],
  neck: [62, 50],
};
const WIDTH = 124;

export const GUIDE_PLACES = Object.fromEntries([
  ...Object.entries(MIDDLE),
  ...Object.entries(RIGHT),
  ...Object.entries(RIGHT).map(([name, [x, y]]) => [name.replace("right_", "left_"), [WIDTH - x, y]]),
]) as Record<PointName, readonly [number, number]>;

export function Guide({ next, points }: { next: PointName | null; points: Points }) {
  return (
    <svg class="guide" viewBox="0 0 124 220" role="img" aria-label={next ? "A figure with the next point marked" : "A figure"}>
      <g class="guide-body">
        <ellipse cx="62" cy="27" rx="12" ry="15" />
        <path d="M62 36v14" stroke-width="10" />
        <path d="M47 58 77 58 73 84 71 100 74 114 50 114 53 100 51 84z" stroke-width="12" />
        <path d="M42 60 34 88 26 122" stroke-width="10" />
        <path d="M82 60 90 88 98 122" stroke-width="10" />
        <path d="M53 114 50 158 48 202 43 208" stroke-width="13" />
        <path d="M71 114 74 158 76 202 81 208" stroke-width="13" />
      </g>
      {(Object.entries(GUIDE_PLACES) as [PointName, readonly [number, number]][]).map(([name, [x, y]]) => (
        <circle
          key={name}
          cx={x}
          cy={y}
          r={name === next ? 5 : 2.2}
          class={`guide-point is-${sideOf(name)} ${name === next ? "is-next" : points.placed[name] ? "is-placed" : ""}`}
        />
      ))}
    </svg>
  );
}
