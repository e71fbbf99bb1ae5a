// A part of the picture enlarged, with a crosshair and the points that lie there.
import type { Picture } from "../draft/picture";
import type { Place } from "../points/placed";
import type { Spot } from "./view";

export interface Magnified {
  readonly picture: Picture;
  /** What lies in the middle, in pixels of the picture. */
  readonly centre: Spot;
  /** CSS pixels for each of the picture's. */
  readonly scale: number;
  readonly sidePx: number;
  readonly places: readonly Place[];
}

export function drawMagnified(canvas: HTMLCanvasElement, { picture, centre, scale, sidePx, places }: Magnified): void {
  const ratio = window.devicePixelRatio || 1;
  canvas.width = canvas.height = sidePx * ratio;
  const context = canvas.getContext("2d")!;
  const half = sidePx / 2;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.fillStyle = "#222";
  context.fillRect(0, 0, sidePx, sidePx);
  context.imageSmoothingEnabled = scale < 4;
  context.drawImage(
    picture.element,
    half - scale * centre.x,
    half - scale * centre.y,
    scale * picture.width,
    scale * picture.height,
  );
  for (const where of places) {
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
