// Pointers on the stage told apart: a tap, a drag of a point, a pan, a pinch.
import type { Spot } from "./view";

/** A press becomes a drag only beyond this: a click near a point must not grab it. */
const DRAG_BEYOND_PX = 4;

export interface Gestures<Grip> {
  /** What a drag that begins here would move; null for nothing. */
  grip(at: Spot, touch: boolean): Grip | null;
  hover(at: Spot | null, touch: boolean): void;
  tap(at: Spot): void;
  dragStart(grip: Grip): void;
  drag(grip: Grip, at: Spot): void;
  dragEnd(grip: Grip): void;
  /** A second finger came, or the browser took the first one's for itself. */
  dragLost(grip: Grip): void;
  pan(dx: number, dy: number): void;
  pinch(factor: number, at: Spot, dx: number, dy: number): void;
}

interface Press<Grip> {
  readonly start: Spot;
  readonly grip: Grip | null;
  readonly touch: boolean;
  readonly panning: boolean;
  moved: boolean;
}

/** Listen on an element; returns how to stop. */
export function listen<Grip>(element: HTMLElement, gestures: Gestures<Grip>): () => void {
  const pointers = new Map<number, Spot>();
  let press: Press<Grip> | null = null;

  const spot = (event: PointerEvent): Spot => {
    const box = element.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };

  const down = (event: PointerEvent): void => {
    if (event.pointerType === "mouse" && event.button > 1) return;
    const at = spot(event);
    element.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, at);
    if (pointers.size > 1) {
      // A second finger: whatever the first began is given up.
      if (press?.moved && press.grip !== null) gestures.dragLost(press.grip);
      press = null;
      gestures.hover(null, true);
      return;
    }
    const touch = event.pointerType === "touch";
    const panning = event.button === 1;
    press = { start: at, grip: panning ? null : gestures.grip(at, touch), touch, panning, moved: false };
    gestures.hover(at, touch);
  };

  const move = (event: PointerEvent): void => {
    const at = spot(event);
    const before = pointers.get(event.pointerId);
    if (!before) {
      gestures.hover(at, event.pointerType === "touch");
      return;
    }
    pointers.set(event.pointerId, at);
    if (pointers.size === 2) {
      const other = [...pointers].find(([id]) => id !== event.pointerId)![1];
      const factor = distance(at, other) / Math.max(1, distance(before, other));
      gestures.pinch(factor, middle(at, other), (at.x - before.x) / 2, (at.y - before.y) / 2);
      return;
    }
    if (!press) return;
    if (!press.moved) {
      if (distance(at, press.start) <= DRAG_BEYOND_PX) return;
      press.moved = true;
      if (press.grip !== null) gestures.dragStart(press.grip);
    }
    if (press.grip !== null) gestures.drag(press.grip, at);
    // One finger aims: it is let go where the point shall be.
    else if (!press.touch) gestures.pan(at.x - before.x, at.y - before.y);
    gestures.hover(at, press.touch);
  };

  const up = (event: PointerEvent): void => {
    if (!pointers.delete(event.pointerId)) return;
    const ended = press;
    press = null;
    if (event.pointerType === "touch") gestures.hover(null, true);
    if (!ended) return;
    if (event.type === "pointercancel") {
      if (ended.moved && ended.grip !== null) gestures.dragLost(ended.grip);
      return;
    }
    if (ended.moved && ended.grip !== null) gestures.dragEnd(ended.grip);
    else if (!ended.panning && (!ended.moved || ended.touch)) gestures.tap(spot(event));
  };

  const leave = (event: PointerEvent): void => {
    if (!pointers.has(event.pointerId)) gestures.hover(null, event.pointerType === "touch");
  };

  const wheel = (event: WheelEvent): void => {
    event.preventDefault();
    const box = element.getBoundingClientRect();
    const at = { x: event.clientX - box.left, y: event.clientY - box.top };
    gestures.pinch(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)), at, 0, 0);
  };

  element.addEventListener("pointerdown", down);
  element.addEventListener("pointermove", move);
  element.addEventListener("pointerup", up);
  element.addEventListener("pointercancel", up);
  element.addEventListener("pointerleave", leave);
  element.addEventListener("wheel", wheel, { passive: false });
  return () => {
    element.removeEventListener("pointerdown", down);
    element.removeEventListener("pointermove", move);
    element.removeEventListener("pointerup", up);
    element.removeEventListener("pointercancel", up);
    element.removeEventListener("pointerleave", leave);
    element.removeEventListener("wheel", wheel);
  };
}

function distance(a: Spot, b: Spot): number {
  return Math.hypot(a.x - b.x, a.y - b.y);
}

function middle(a: Spot, b: Spot): Spot {
  return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
}
