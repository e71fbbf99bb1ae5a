// What brushes add to a mask and take from it: in pixels of the picture, so that it can be drawn at any size.
import { toPicture } from "../stage/view";
import type { Size, Spot, View } from "../stage/view";

export type Brush = "add" | "remove";

export interface Stroke {
  readonly brush: Brush;
  readonly radius: number;
  readonly path: readonly Spot[];
}

/** Radii as shares of the picture's diagonal: a finger of a small person, and a trunk. */
export const LEAST_RADIUS = 0.002;
export const MOST_RADIUS = 0.08;
export const FIRST_RADIUS = 0.018;

export function radiusPx(share: number, { width, height }: Size): number {
  return share * Math.hypot(width, height);
}

/** Where a slider stands from 0 to 100: sizes feel alike where they have a ratio. */
export function sliderOf(share: number): number {
  return (100 * Math.log(share / LEAST_RADIUS)) / Math.log(MOST_RADIUS / LEAST_RADIUS);
}

export function shareOf(slider: number): number {
  const within = Math.min(Math.max(slider, 0), 100);
  return LEAST_RADIUS * (MOST_RADIUS / LEAST_RADIUS) ** (within / 100);
}

export function strokeAt(brush: Brush, radius: number, view: View, at: Spot): Stroke {
  return { brush, radius, path: [toPicture(view, at)] };
}

export function extended(stroke: Stroke, to: Spot): Stroke {
  return { ...stroke, path: [...stroke.path, to] };
}

/** Draw from a place of the path to its end; a canvas where the person is opaque, `scale` times the picture. */
export function draw(context: CanvasRenderingContext2D, { brush, radius, path }: Stroke, scale: number, from = 0): void {
  context.globalCompositeOperation = brush === "add" ? "source-over" : "destination-out";
  context.fillStyle = context.strokeStyle = "#fff";
  context.lineWidth = 2 * radius * scale;
  context.lineCap = context.lineJoin = "round";
  const first = path[from]!;
  // A line to its own beginning leaves nothing: the dot is drawn by itself.
  context.beginPath();
  context.arc(first.x * scale, first.y * scale, radius * scale, 0, 2 * Math.PI);
  context.fill();
  context.beginPath();
  context.moveTo(first.x * scale, first.y * scale);
  for (const { x, y } of path.slice(from + 1)) context.lineTo(x * scale, y * scale);
  context.stroke();
  context.globalCompositeOperation = "source-over";
}
