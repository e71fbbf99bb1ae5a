// Brushes without a pointer: the arrow keys move one, Enter dabs.
import type { Signal } from "@preact/signals";
import type { PictureView } from "../stage/pictureView";
import { nudged } from "../stage/view";
import type { Spot } from "../stage/view";
import { stepOf, zoomsBy } from "../stage/viewKeys";
import { shareOf, sliderOf } from "./strokes";
import type { Brush } from "./strokes";

const SIZE_STEP = 8;

interface KeyContext {
  readonly lies: PictureView;
  readonly cursor: Signal<Spot | null>;
  readonly brush: Signal<Brush>;
  readonly share: Signal<number>;
  readonly dab: (at: Spot) => void;
}

export function maskKeys(event: KeyboardEvent, context: KeyContext): void {
  if (event.target !== event.currentTarget || event.ctrlKey || event.metaKey) return;
  if (act(event, context)) event.preventDefault();
}

function act(event: KeyboardEvent, { lies, cursor, brush, share, dab }: KeyContext): boolean {
  const moved = (dx: number, dy: number) => (cursor.value = nudged(lies.view.value, cursor.value, dx, dy, lies.picture));
  const step = stepOf(event);
  if (step) {
    moved(...step);
    return true;
  }
  switch (event.key) {
    case "Enter":
    case " ":
      dab(cursor.value ?? moved(0, 0));
      return true;
    case "x":
      brush.value = brush.value === "add" ? "remove" : "add";
      return true;
    case "[":
    case "]":
      share.value = shareOf(sliderOf(share.value) + (event.key === "[" ? -SIZE_STEP : SIZE_STEP));
      return true;
    default:
      return zoomsBy(event, lies);
  }
}
