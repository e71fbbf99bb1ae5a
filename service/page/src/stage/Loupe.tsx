// What lies under the pointer, enlarged, out of its way.
import { useEffect, useRef } from "preact/hooks";
import { points } from "../draft/draft";
import type { Picture } from "../draft/picture";
import { drawMagnified } from "./magnified";
import { toPicture } from "./view";
import type { Size, Spot, View } from "./view";

const SIDE_PX = 132;
const ENLARGED = 4;
const ABOVE_FINGER_PX = 46;
const CORNER_PX = 12;

interface Props {
  readonly at: Spot;
  readonly touch: boolean;
  readonly view: View;
  readonly size: Size;
  readonly picture: Picture;
}

export function Loupe({ at, touch, view, size, picture }: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const target = canvas.current!;
    const { left, top } = placeOf(at, touch, size);
    target.style.transform = `translate(${left}px, ${top}px)`;
    drawMagnified(target, {
      picture,
      centre: toPicture(view, at),
      scale: ENLARGED * view.scale,
      sidePx: SIDE_PX,
      places: Object.values(points.value.placed),
    });
  });
  return <canvas class="loupe" ref={canvas} aria-hidden="true" />;
}

function placeOf(at: Spot, touch: boolean, size: Size): { left: number; top: number } {
  const right = size.width - SIDE_PX - CORNER_PX;
  if (!touch) {
    // A corner of the stage, the other one when the pointer comes near.
    const isNear = at.x > right - 60 && at.y < SIDE_PX + 80;
    return { left: isNear ? CORNER_PX : right, top: CORNER_PX };
  }
  const above = at.y - SIDE_PX - ABOVE_FINGER_PX;
  const left = Math.min(Math.max(at.x - SIDE_PX / 2, 0), size.width - SIDE_PX);
  if (above >= 0) return { left, top: above };
  return { left: at.x > size.width / 2 ? CORNER_PX : right, top: CORNER_PX };
}
