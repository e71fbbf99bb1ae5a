// Keys that mean the same on every stage.
import type { PictureView } from "./pictureView";

const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};
const LARGE_STEP = 10;
const KEY_ZOOM = 1.25;

/** By how many pixels of the picture an arrow key moves; null for other keys. */
export function stepOf(event: KeyboardEvent): readonly [number, number] | null {
  const arrow = ARROWS[event.key];
  if (!arrow) return null;
  const step = event.shiftKey ? LARGE_STEP : 1;
  return [arrow[0] * step, arrow[1] * step];
}

/** Whether the key was one of those that zoom. */
export function zoomsBy(event: KeyboardEvent, { zoom, whole }: PictureView): boolean {
  if (event.key === "+" || event.key === "=") zoom(KEY_ZOOM);
  else if (event.key === "-") zoom(1 / KEY_ZOOM);
  else if (event.key === "0") whole();
  else return false;
  return true;
}
