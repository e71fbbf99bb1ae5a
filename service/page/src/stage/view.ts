// How the picture lies on the stage: screen = scale * picture + offset, both in CSS pixels.

export interface View {
  readonly scale: number;
  readonly x: number;
  readonly y: number;
}

export interface Size {
  readonly width: number;
  readonly height: number;
}

export interface Spot {
  readonly x: number;
  readonly y: number;
}

const MARGIN = 16;
const MAX_SCALE = 16;

/** The whole picture, in the middle. */
export function fitted(stage: Size, picture: Size): View {
  const room = { width: Math.max(1, stage.width - 2 * MARGIN), height: Math.max(1, stage.height - 2 * MARGIN) };
  const scale = Math.min(room.width / picture.width, room.height / picture.height);
  return { scale, x: (stage.width - scale * picture.width) / 2, y: (stage.height - scale * picture.height) / 2 };
}

/** Around people: this share of their size is left free. */
const FREE = 0.16;
/** A gain of less is not worth that the picture is no longer whole. */
const LEAST_GAIN = 1.4;
/** Who covers more of the picture is seen well enough in all of it, however narrow the stage. */
const LARGE_SHARE = 0.4;

/** As large as the stage allows what is to be looked at: left, top, right and bottom in the picture. */
export function framed(stage: Size, picture: Size, box: readonly [number, number, number, number] | null): View {
  const whole = fitted(stage, picture);
  if (!box) return whole;
  const [left, top, right, bottom] = box;
  if ((right - left) * (bottom - top) > LARGE_SHARE * picture.width * picture.height) return whole;
  const scale = Math.min(stage.width / (right - left), stage.height / (bottom - top)) / (1 + FREE);
  if (scale < LEAST_GAIN * whole.scale) return whole;
  return kept({ scale, x: (stage.width - scale * (left + right)) / 2, y: (stage.height - scale * (top + bottom)) / 2 }, stage, picture);
}

/** Enlarged so that the spot of the picture under `at` stays where it is. */
export function zoomed(view: View, factor: number, at: Spot, stage: Size, picture: Size): View {
  const least = fitted(stage, picture).scale;
  const scale = Math.min(Math.max(view.scale * factor, least), Math.max(MAX_SCALE, least));
  const ratio = scale / view.scale;
  return kept({ scale, x: at.x - ratio * (at.x - view.x), y: at.y - ratio * (at.y - view.y) }, stage, picture);
}

export function panned(view: View, dx: number, dy: number, stage: Size, picture: Size): View {
  return kept({ ...view, x: view.x + dx, y: view.y + dy }, stage, picture);
}

export function toPicture(view: View, spot: Spot): Spot {
  return { x: (spot.x - view.x) / view.scale, y: (spot.y - view.y) / view.scale };
}

export function toStage(view: View, spot: Spot): Spot {
  return { x: view.scale * spot.x + view.x, y: view.scale * spot.y + view.y };
}

export function isSame(view: View, other: View): boolean {
  return Math.abs(view.scale - other.scale) < 1e-6;
}

/** The spot of the picture that is nearest. */
export function inside(spot: Spot, picture: Size): Spot {
  return { x: Math.min(Math.max(spot.x, 0), picture.width), y: Math.min(Math.max(spot.y, 0), picture.height) };
}

/** A spot of the stage moved by pixels of the picture, whose middle is meant where there is none. */
export function nudged(view: View, at: Spot | null, dx: number, dy: number, picture: Size): Spot {
  const from = at ? toPicture(view, at) : { x: picture.width / 2, y: picture.height / 2 };
  return toStage(view, inside({ x: from.x + dx, y: from.y + dy }, picture));
}

/** The picture stays in the middle where it is smaller than the stage, and covers it elsewhere. */
function kept(view: View, stage: Size, picture: Size): View {
  return {
    scale: view.scale,
    x: keptAlong(view.x, view.scale * picture.width, stage.width),
    y: keptAlong(view.y, view.scale * picture.height, stage.height),
  };
}

function keptAlong(offset: number, length: number, room: number): number {
  if (length + 2 * MARGIN <= room) return (room - length) / 2;
  return Math.min(MARGIN, Math.max(room - length - MARGIN, offset));
}
