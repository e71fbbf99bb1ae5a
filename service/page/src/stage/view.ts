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

export function isWhole(view: View, stage: Size, picture: Size): boolean {
  return Math.abs(view.scale - fitted(stage, picture).scale) < 1e-6;
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
