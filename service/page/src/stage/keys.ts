// The stage without a mouse.
import type { Signal } from "@preact/signals";
import { change, points, selected, timeline, upcoming } from "../draft/draft";
import { place, remove, skip, toggleHidden } from "../points/placed";
import { redo, undo } from "../points/timeline";
import { inside, placeNext } from "./placing";
import { toPicture, toStage } from "./view";
import type { Size, Spot, View } from "./view";

const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};
const LARGE_STEP = 10;
const KEY_ZOOM = 1.25;

interface KeyContext {
  readonly zoom: (factor: number) => void;
  readonly whole: () => void;
  readonly shown: Size;
  readonly aim: Signal<{ at: Spot; touch: boolean } | null>;
  readonly view: Signal<View>;
}

export function stageKeys(event: KeyboardEvent, context: KeyContext): void {
  if (event.target !== event.currentTarget) return;
  if (act(event, context)) event.preventDefault();
}

function act(event: KeyboardEvent, { zoom, whole, shown, aim, view }: KeyContext): boolean {
  const name = selected.value;
  const next = upcoming.value;
  const arrow = ARROWS[event.key];
  // Undo and redo belong to the whole page.
  if (event.ctrlKey || event.metaKey) return false;
  if (arrow) {
    const step = event.shiftKey ? LARGE_STEP : 1;
    const [dx, dy] = [arrow[0] * step, arrow[1] * step];
    const where = name && points.value.placed[name];
    if (name && where) {
      const moved = inside({ x: where.x + dx, y: where.y + dy }, shown);
      change(place(points.value, name, moved.x, moved.y));
    } else {
      const from = aim.value ? toPicture(view.value, aim.value.at) : { x: shown.width / 2, y: shown.height / 2 };
      aim.value = { at: toStage(view.value, inside({ x: from.x + dx, y: from.y + dy }, shown)), touch: false };
    }
    return true;
  }
  switch (event.key) {
    case "Enter":
    case " ":
      if (next && aim.value) {
        const at = inside(toPicture(view.value, aim.value.at), shown);
        placeNext(next, at.x, at.y);
        selected.value = null;
      }
      return true;
    case "Escape":
      selected.value = null;
      return true;
    case "Delete":
    case "Backspace":
      if (name) change(remove(points.value, name));
      selected.value = null;
      return true;
    case "h":
      if (name) change(toggleHidden(points.value, name));
      return true;
    case "s":
      if (next) change(skip(points.value, next));
      return true;
    case "+":
    case "=":
      zoom(KEY_ZOOM);
      return true;
    case "-":
      zoom(1 / KEY_ZOOM);
      return true;
    case "0":
      whole();
      return true;
    default:
      return false;
  }
}

/** Control Z, Control Shift Z and Control Y; fields keep their own. */
export function timeTravel(event: KeyboardEvent): void {
  const typing = event.target instanceof HTMLInputElement && event.target.type !== "radio";
  if (typing || (!event.ctrlKey && !event.metaKey)) return;
  const key = event.key.toLowerCase();
  if (key === "z") timeline.value = event.shiftKey ? redo(timeline.value) : undo(timeline.value);
  else if (key === "y") timeline.value = redo(timeline.value);
  else return;
  event.preventDefault();
}
