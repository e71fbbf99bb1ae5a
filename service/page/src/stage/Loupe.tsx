// What lies under the pointer, enlarged, out of its way.
import { useEffect, useRef } from "preact/hooks";
import { points } from "../draft/draft";
import type { Picture } from "../draft/picture";
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
    const ratio = window.devicePixelRatio || 1;
    target.width = target.height = SIDE_PX * ratio;
    const { left, top } = placeOf(at, touch, size);
    target.style.transform = `translate(${left}px, ${top}px)`;
    draw(target.getContext("2d")!, ratio, toPicture(view, at), ENLARGED * view.scale, picture);
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

function draw(context: CanvasRenderingContext2D, ratio: number, centre: Spot, scale: number, picture: Picture): void {
  const half = SIDE_PX / 2;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.fillStyle = "#222";
  context.fillRect(0, 0, SIDE_PX, SIDE_PX);
  context.imageSmoothingEnabled = scale < 4;
  context.drawImage(
    picture.element,
    half - scale * centre.x,
    half - scale * centre.y,
    scale * picture.width,
    scale * picture.height,
  );
  for (const where of Object.values(points.value.placed)) {
    const [x, y] = [half + scale * (where.x - centre.x), half + scale * (where.y - centre.y)];
    context.beginPath();
    context.arc(x, y, 5, 0, 2 * Math.PI);
    context.lineWidth = 2;
    context.strokeStyle = "rgba(255, 255, 255, 0.9)";
    context.stroke();
  }
  for (const [width, colour] of [[3, "rgba(0, 0, 0, 0.55)"], [1, "#fff"]] as const) {
    context.lineWidth = width;
    context.strokeStyle = colour;
    context.beginPath();
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]] as const) {
      context.moveTo(half + 5 * dx, half + 5 * dy);
      context.lineTo(half + 26 * dx, half + 26 * dy);
    }
    context.stroke();
  }
}
