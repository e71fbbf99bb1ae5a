// The stage over the whole window, where there is little room. Not by the browser's own full screen, which iPhones lack.
import { effect, signal } from "@preact/signals";

export const isFull = signal(false);

export function startFilling(): void {
  const leave = (event: KeyboardEvent) => {
    if (event.key === "Escape") isFull.value = false;
  };
  effect(() => {
    if (!isFull.value) return undefined;
    addEventListener("keydown", leave);
    return () => removeEventListener("keydown", leave);
  });
}
