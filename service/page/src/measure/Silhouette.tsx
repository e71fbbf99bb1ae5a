// How to stand, drawn: from the front with arms and legs apart, from the side with the arms stretched forward.
import { messages } from "../messages";
import type { PlaceName } from "./places";

const BOX = "0 0 120 220";

const SHAPES: Readonly<Record<PlaceName, readonly (readonly [path: string, width: number])[]>> = {
  front: [
    ["M60 26v.01", 25],
    ["M60 22v8", 23],
    ["M60 34v16", 11],
    ["M45 56 75 56 71 82 69 96 72 112 48 112 51 96 49 82z", 13],
    ["M42 58 28 84 13 110", 10],
    ["M78 58 92 84 107 110", 10],
    ["M50 116 44 160 38 202 33 206", 13],
    ["M70 116 76 160 82 202 87 206", 13],
  ],
  side: [
    ["M59 25v.01", 25],
    ["M60 24 60 31", 22],
    ["M57 34 55 50", 12],
    ["M52 58 58 58 60 80 58 96 59 112 49 112 48 96 49 80z", 15],
    ["M56 60 84 62 112 60", 9],
    ["M54 116 55 160 53 202 65 206", 15],
  ],
};

export function Silhouette({ view }: { view: PlaceName }) {
  return (
    <svg class="silhouette" viewBox={BOX} role="img" aria-label={messages.measure.place.drawn[view]}>
      <g class="silhouette-body">
        {SHAPES[view].map(([path, width]) => (
          <path key={path} d={path} stroke-width={width} />
        ))}
      </g>
    </svg>
  );
}

/** The same as an outline to be matched over the picture of a camera. */
export function SilhouetteOutline({ view, mirrored }: { view: PlaceName; mirrored: boolean }) {
  const mask = `silhouette-${view}`;
  return (
    <svg class={`silhouette-outline ${mirrored ? "is-mirrored" : ""}`} viewBox={BOX} aria-hidden="true">
      <mask id={mask} maskUnits="userSpaceOnUse" x="0" y="0" width="120" height="220">
        <Shapes view={view} colour="#fff" wider={3} />
        <Shapes view={view} colour="#000" wider={0} />
      </mask>
      <rect width="120" height="220" fill="#fff" mask={`url(#${mask})`} />
    </svg>
  );
}

function Shapes({ view, colour, wider }: { view: PlaceName; colour: string; wider: number }) {
  return (
    <g fill={colour} stroke={colour} stroke-linecap="round" stroke-linejoin="round">
      {SHAPES[view].map(([path, width]) => (
        <path key={path} d={path} fill={path.endsWith("z") ? colour : "none"} stroke-width={width + wider} />
      ))}
    </g>
  );
}
