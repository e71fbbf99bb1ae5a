// Masks as canvases: opaque on the person, clear elsewhere.
import type { Size, View } from "../stage/view";
import { draw } from "./strokes";
import type { Stroke } from "./strokes";

/** A mask drawn at `scale` times the picture's size. */
export interface DrawnMask {
  readonly canvas: HTMLCanvasElement;
  readonly scale: number;
}

/** What is as probably the person's as not. */
const INSIDE = 128;
/** So large is a mask that is shown: what is finer is not seen, and brushes would lag. */
const SHOWN_PIXELS = 1_500_000;

const EDGE = "#ffc400";
const RIM = "rgb(0 0 0 / 65%)";
const TINT = "rgb(255 196 0 / 32%)";
const EDGE_PX = 1.4;
const RIM_PX = 2.6;
const AROUND = [[1, 0], [-1, 0], [0, 1], [0, -1], [0.7, 0.7], [-0.7, 0.7], [0.7, -0.7], [-0.7, -0.7]] as const;

export function shownScale({ width, height }: Size): number {
  return Math.min(1, Math.sqrt(SHOWN_PIXELS / (width * height)));
}

/** A mask's file, white on the person, drawn with what brushes did to it. */
export function drawnMask(base: HTMLImageElement, strokes: readonly Stroke[], picture: Size, scale: number): DrawnMask {
  const canvas = blank(Math.round(scale * picture.width), Math.round(scale * picture.height));
  const context = canvas.getContext("2d", { willReadFrequently: true })!;
  context.drawImage(base, 0, 0, canvas.width, canvas.height);
  const pixels = context.getImageData(0, 0, canvas.width, canvas.height);
  const { data } = pixels;
  for (let i = 0; i < data.length; i += 4) {
    data[i + 3] = data[i]! >= INSIDE ? 255 : 0;
    data[i] = data[i + 1] = data[i + 2] = 255;
  }
  context.putImageData(pixels, 0, 0);
  for (const stroke of strokes) draw(context, stroke, scale);
  return { canvas, scale };
}

/** White on the person and black elsewhere, nothing between: as a fit takes it. */
export function maskFile({ canvas }: DrawnMask): Promise<Blob | null> {
  const context = canvas.getContext("2d")!;
  const pixels = context.getImageData(0, 0, canvas.width, canvas.height);
  const { data } = pixels;
  for (let i = 0; i < data.length; i += 4) {
    data[i] = data[i + 1] = data[i + 2] = data[i + 3]! >= INSIDE ? 255 : 0;
    data[i + 3] = 255;
  }
  context.putImageData(pixels, 0, 0);
  return new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
}

/** The mask as it lies on a stage: its outline, equally wide at any scale, and a tint unless points lie over it. */
export function showMask(target: HTMLCanvasElement, mask: DrawnMask, view: View, size: Size, isTinted: boolean): void {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [Math.round(ratio * size.width), Math.round(ratio * size.height)];
  // Scaled once, and then moved by pixels: scaling is what takes long.
  const flat = blank(width, height);
  const scaled = flat.getContext("2d")!;
  const drawn = (ratio * view.scale) / mask.scale;
  scaled.setTransform(drawn, 0, 0, drawn, ratio * view.x, ratio * view.y);
  scaled.drawImage(mask.canvas, 0, 0);

  target.width = width;
  target.height = height;
  const context = target.getContext("2d")!;
  for (const [reach, colour] of [[RIM_PX, RIM], [EDGE_PX, EDGE]] as const) {
    context.drawImage(coloured(spread(flat, reach * ratio), colour), 0, 0);
  }
  context.globalCompositeOperation = "destination-out";
  context.drawImage(flat, 0, 0);
  context.globalCompositeOperation = "source-over";
  if (isTinted) context.drawImage(coloured(flat, TINT), 0, 0);
}

function spread(mask: HTMLCanvasElement, reach: number): HTMLCanvasElement {
  const wider = blank(mask.width, mask.height);
  const context = wider.getContext("2d")!;
  for (const [dx, dy] of AROUND) context.drawImage(mask, reach * dx, reach * dy);
  return wider;
}

function coloured(mask: HTMLCanvasElement, colour: string): HTMLCanvasElement {
  const painted = blank(mask.width, mask.height);
  const context = painted.getContext("2d")!;
  context.drawImage(mask, 0, 0);
  context.globalCompositeOperation = "source-in";
  context.fillStyle = colour;
  context.fillRect(0, 0, mask.width, mask.height);
  return painted;
}

function blank(width: number, height: number): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  return canvas;
}
