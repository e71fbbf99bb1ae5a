// A picture on a stage: where it lies, and what moves it. The stage may change its size.
import { useSignal } from "@preact/signals";
import type { Signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { RefObject } from "preact";
import type { Picture } from "../draft/picture";
import { fitted, framed, isSame, panned, zoomed } from "./view";
import type { Size, Spot, View } from "./view";

export interface PictureView {
  readonly picture: Picture;
  readonly box: RefObject<HTMLDivElement | null>;
  readonly size: Signal<Size>;
  readonly view: Signal<View>;
  readonly whole: () => void;
  /** About the middle unless a spot is given. */
  readonly zoom: (factor: number, at?: Spot) => void;
  readonly pan: (dx: number, dy: number) => void;
  readonly pinch: (factor: number, at: Spot, dx: number, dy: number) => void;
}

/** `looked` is what is shown as large as the stage allows, until somebody looks elsewhere; null is all of it. */
export function usePictureView(picture: Picture, looked: readonly [number, number, number, number] | null = null): PictureView {
  const box = useRef<HTMLDivElement>(null);
  const size = useSignal<Size>({ width: 0, height: 0 });
  const view = useSignal<View>({ scale: 1, x: 0, y: 0 });
  const sought = useRef(looked);

  const home = () => framed(size.value, picture, sought.current);
  const whole = () => (view.value = fitted(size.value, picture));
  const zoom = (factor: number, at: Spot = { x: size.value.width / 2, y: size.value.height / 2 }) =>
    (view.value = zoomed(view.value, factor, at, size.value, picture));
  const pan = (dx: number, dy: number) => (view.value = panned(view.value, dx, dy, size.value, picture));
  const pinch = (factor: number, at: Spot, dx: number, dy: number) => {
    zoom(factor, at);
    pan(dx, dy);
  };

  useEffect(() => {
    const observer = new ResizeObserver(([entry]) => {
      const { width, height } = entry!.contentRect;
      const untouched = size.value.width === 0 || isSame(view.value, home());
      size.value = { width, height };
      if (untouched) view.value = home();
      else pan(0, 0);
    });
    observer.observe(box.current!);
    return () => observer.disconnect();
  }, [picture]);

  useEffect(() => {
    // The box is there some time after the picture.
    const untouched = isSame(view.value, home());
    sought.current = looked;
    if (size.value.width > 0 && untouched) view.value = home();
  }, [looked]);

  useEffect(() => {
    if (size.value.width > 0) view.value = home();
  }, [picture]);

  return { picture, box, size, view, whole, zoom, pan, pinch };
}
