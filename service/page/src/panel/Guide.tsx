// A small figure that shows which point is meant. It faces the viewer: its left is on the right.
import { messages } from "../messages";
import { sideOf } from "../points/catalogue";
import type { PointName } from "../points/catalogue";
import type { Points } from "../points/placed";

const RIGHT: Readonly<Partial<Record<PointName, readonly [number, number]>>> = {
  right_shoulder: [45, 60],
  right_elbow: [35, 89],
  right_wrist: [27, 118],
  right_hip: [53, 113],
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

/** Drawn larger about these joints, since people mistake where they are. */
const CLOSE_UPS: Readonly<Partial<Record<PointName, string>>> = {
  left_hip: "36 82 52 64",
  right_hip: "36 82 52 64",
  left_shoulder: "36 34 52 64",
  right_shoulder: "36 34 52 64",
};

export function Guide({ next, points }: { next: PointName | null; points: Points }) {
  const { guide } = messages.panel;
  const closeUp = next && CLOSE_UPS[next];
  return (
    <div class="guides">
      <svg class="guide" viewBox="0 0 124 220" role="img" aria-label={next ? guide.labelNext : guide.label}>
        <Figure />
        <text class="guide-side is-right" x="12" y="86">{guide.right}</text>
        <text class="guide-side is-left" x="112" y="86">{guide.left}</text>
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
      {next && closeUp && <CloseUp next={next} box={closeUp} />}
    </div>
  );
}

/** The trunk's end enlarged: where the bones meet, and for hips the waist struck out. */
function CloseUp({ next, box }: { next: PointName; box: string }) {
  const [x, y] = GUIDE_PLACES[next];
  const isHip = next.endsWith("_hip");
  return (
    <svg class="guide-close-up" viewBox={box} aria-hidden="true">
      <Figure />
      {isHip && (
        <>
          <path class="guide-wrong" d="M44 96h36" />
          <text class="guide-word" x="62" y="94">{messages.panel.guide.notWaist}</text>
          <path class="guide-bone" d="M53 113 50 158M71 113 74 158M53 113h18" />
        </>
      )}
      {!isHip && <path class="guide-bone" d="M45 60 35 89M79 60 89 89M45 60h34" />}
      <circle cx={x} cy={y} r="2.6" class={`guide-point is-${sideOf(next)} is-next is-still`} />
    </svg>
  );
}

function Figure() {
  return (
    <g class="guide-body">
      <ellipse cx="62" cy="27" rx="12" ry="15" />
      <path d="M62 36v14" stroke-width="10" />
      <path d="M47 58 77 58 73 84 71 98 74 112 50 112 53 98 51 84z" stroke-width="12" />
      <path d="M42 60 34 88 26 122" stroke-width="10" />
      <path d="M82 60 90 88 98 122" stroke-width="10" />
      <path d="M53 114 50 158 48 202 43 208" stroke-width="13" />
      <path d="M71 114 74 158 76 202 81 208" stroke-width="13" />
      <path class="guide-face" d="M57.5 26h.01M66.5 26h.01M58.5 33.5q3.5 2.5 7 0" />
    </g>
  );
}
