// The stage without a mouse.
import type { Signal } from "@preact/signals";
import { change, points, selected, timeline, upcoming } from "../draft/draft";
import { place, remove, skip, toggleHidden } from "../points/placed";
import { redo, undo } from "../points/timeline";
import type { PictureView } from "./pictureView";
import { placeNext } from "./placing";
import { inside, nudged, toPicture } from "./view";
import type { Spot } from "./view";
import { stepOf, zoomsBy } from "./viewKeys";

interface KeyContext {
  readonly lies: PictureView;
  readonly aim: Signal<{ at: Spot; touch: boolean } | null>;
}

export function stageKeys(event: KeyboardEvent, context: KeyContext): void {
  if (event.target !== event.currentTarget) return;
  if (act(event, context)) event.preventDefault();
}

function act(event: KeyboardEvent, { lies, aim }: KeyContext): boolean {
  const { picture: shown, view } = lies;
  const name = selected.value;
  const next = upcoming.value;
  const step = stepOf(event);
  // Undo and redo belong to the whole page.
  if (event.ctrlKey || event.metaKey) return false;
  if (step) {
    const [dx, dy] = step;
    const where = name && points.value.placed[name];
    if (name && where) {
      const moved = inside({ x: where.x + dx, y: where.y + dy }, shown);
      change(place(points.value, name, moved.x, moved.y));
    } else {
      aim.value = { at: nudged(view.value, aim.value?.at ?? null, dx, dy, shown), touch: false };
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
    default:
      return zoomsBy(event, lies);
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
