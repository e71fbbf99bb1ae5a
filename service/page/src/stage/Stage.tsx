// The picture with its points: where a person clicks.
import { useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { adjust, change, mask, picture, points, selected, timeline, upcoming } from "../draft/draft";
import { proposalWord } from "../draft/proposing";
import { pointOf } from "../points/catalogue";
import type { PointName } from "../points/catalogue";
import { isEnough, place, skip, skipRest } from "../points/placed";
import { hasProposed } from "../points/proposed";
import { advance, undo } from "../points/timeline";
import { IconButton } from "../ui/IconButton";
import { MaskOutline } from "../ui/MaskOutline";
import { ClickLayer } from "./ClickLayer";
import { PersonBoxes } from "./PersonBoxes";
import { listen } from "./gestures";
import { stageKeys, timeTravel } from "./keys";
import { Loupe } from "./Loupe";
import { inside, nearest, tap } from "./placing";
import { fitted, panned, toPicture, toStage, zoomed } from "./view";
import type { Size, Spot, View } from "./view";

const GRIP_PX = { mouse: 10, touch: 22 };
const BUTTON_ZOOM = 1.5;

export function Stage() {
  const shown = picture.value!;
  const box = useRef<HTMLDivElement>(null);
  const size = useSignal<Size>({ width: 0, height: 0 });
  const view = useSignal<View>({ scale: 1, x: 0, y: 0 });
  const aim = useSignal<{ at: Spot; touch: boolean } | null>(null);
  const dragged = useSignal<PointName | null>(null);

  const whole = () => (view.value = fitted(size.value, shown));
  const zoom = (factor: number, at: Spot = { x: size.value.width / 2, y: size.value.height / 2 }) =>
    (view.value = zoomed(view.value, factor, at, size.value, shown));

  useEffect(() => {
    const observer = new ResizeObserver(([entry]) => {
      const { width, height } = entry!.contentRect;
      const untouched = size.value.width === 0 || isWhole(view.value, size.value, shown);
      size.value = { width, height };
      view.value = untouched ? fitted(size.value, shown) : panned(view.value, 0, 0, size.value, shown);
    });
    observer.observe(box.current!);
    return () => observer.disconnect();
  }, [shown]);

  useEffect(() => {
    if (size.value.width > 0) whole();
  }, [shown]);

  useEffect(
    () =>
      listen<PointName>(box.current!, {
        grip: (at, touch) => nearest(view.value, at, touch ? GRIP_PX.touch : GRIP_PX.mouse),
        hover: (at, touch) => (aim.value = at && { at, touch }),
        tap: (at) => tap(at, view.value, shown),
        dragStart: (name) => {
          // The step to go back to is the point where it was.
          timeline.value = advance(timeline.value, { ...points.value });
          selected.value = name;
          dragged.value = name;
        },
        drag: (name, at) => {
          const { x, y } = inside(toPicture(view.value, at), shown);
          adjust(place(points.value, name, x, y));
        },
        dragEnd: () => (dragged.value = null),
        pan: (dx, dy) => (view.value = panned(view.value, dx, dy, size.value, shown)),
        pinch: (factor, at, dx, dy) => {
          view.value = panned(zoomed(view.value, factor, at, size.value, shown), dx, dy, size.value, shown);
        },
      }),
    [shown],
  );

  // Wherever the focus is: a button that mends something is gone once it has.
  useEffect(() => {
    addEventListener("keydown", timeTravel);
    return () => removeEventListener("keydown", timeTravel);
  }, []);

  // A point moved by keys stays in sight.
  useSignalEffect(() => {
    const where = selected.value && points.value.placed[selected.value];
    if (!where || dragged.value) return;
    const at = toStage(view.peek(), where);
    const { width, height } = size.peek();
    const dx = at.x < 0 ? 24 - at.x : at.x > width ? width - 24 - at.x : 0;
    const dy = at.y < 0 ? 24 - at.y : at.y > height ? height - 24 - at.y : 0;
    if (dx || dy) view.value = panned(view.peek(), dx, dy, size.peek(), shown);
  });

  const { scale, x, y } = view.value;
  const name = upcoming.value;
  return (
    <div
      class={`stage ${dragged.value ? "is-dragging" : name ? "is-placing" : ""}`}
      ref={box}
      tabIndex={0}
      role="application"
      aria-busy={size.value.width === 0}
      aria-label={`Picture to click on. ${name ? `Next: ${pointOf(name).label}.` : `All points are ${hasProposed(points.value) ? "proposed" : "placed"}.`}`}
      aria-describedby="stage-keys"
      onKeyDown={(event) => stageKeys(event, { zoom, whole, shown, aim, view })}
    >
      <img
        class={`stage-picture ${scale > 3 ? "is-pixelated" : ""}`}
        src={shown.url}
        alt=""
        draggable={false}
        width={shown.width}
        height={shown.height}
        style={{ transform: `translate(${x}px, ${y}px) scale(${scale})` }}
      />
      {mask.value && (
        <div
          class="stage-picture"
          style={{ width: shown.width, height: shown.height, transform: `translate(${x}px, ${y}px) scale(${scale})` }}
        >
          <MaskOutline url={mask.value.url} label="The border of the mask" />
        </div>
      )}
      <PersonBoxes view={view.value} size={size.value} />
      {proposalWord.value && (
        <p class="stage-word" aria-hidden="true">
          {proposalWord.value}
        </p>
      )}
      <ClickLayer view={view.value} size={size.value} dragged={dragged.value} />
      {aim.value && (name !== null || dragged.value) && (
        <Loupe at={aim.value.at} touch={aim.value.touch} view={view.value} size={size.value} picture={shown} />
      )}
      <div class="stage-tools" onPointerDown={(event) => event.stopPropagation()}>
        <IconButton
          icon="undo"
          label="Take the last change back"
          disabled={timeline.value.past.length === 0}
          onClick={() => (timeline.value = undo(timeline.value))}
        />
        <IconButton icon="minus" label="Zoom out" onClick={() => zoom(1 / BUTTON_ZOOM)} />
        <IconButton icon="frame" label="Show the whole picture" onClick={whole} />
        <IconButton icon="plus" label="Zoom in" onClick={() => zoom(BUTTON_ZOOM)} />
        {name && <IconButton icon="skip" label={`Skip: ${pointOf(name).label}`} onClick={() => change(skip(points.value, name))} />}
        {name && isEnough(points.value) && (
          <IconButton icon="check" label="Enough points" onClick={() => change(skipRest(points.value))} />
        )}
      </div>
      <p id="stage-keys" class="unseen">
        Arrow keys move the selected point, or the crosshair when none is selected; Shift moves ten pixels. Enter places
        the next point at the crosshair, Escape selects nothing, S skips, H marks as hidden, Delete removes, plus and
        minus zoom, 0 shows the whole picture, Control Z undoes.
      </p>
    </div>
  );
}

function isWhole(view: View, size: Size, picture: Size): boolean {
  return Math.abs(view.scale - fitted(size, picture).scale) < 1e-6;
}
