// The picture with its mask, under brushes.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { current, strokes } from "../draft/draft";
import { messages } from "../messages";
import { redo, undo } from "../points/timeline";
import { listen } from "../stage/gestures";
import { usePictureView } from "../stage/pictureView";
import { StagePicture } from "../stage/StagePicture";
import { toPicture } from "../stage/view";
import type { Spot } from "../stage/view";
import { addStroke, isEditing, redrawMask, shownMask } from "./edits";
import { maskKeys } from "./keys";
import { MaskLayer } from "./MaskLayer";
import { MaskTools } from "./MaskTools";
import { draw, extended, FIRST_RADIUS, radiusPx, strokeAt } from "./strokes";
import type { Brush, Stroke } from "./strokes";

export function MaskStage() {
  const { mask: words } = messages;
  const shown = current.value!.picture;
  const mask = shownMask.value;
  const lies = usePictureView(shown);
  const { box, size, view, pan, pinch } = lies;
  const cursor = useSignal<Spot | null>(null);
  const brush = useSignal<Brush>("add");
  const share = useSignal(FIRST_RADIUS);
  const drawn = useSignal(0);

  const radius = () => radiusPx(share.value, shown);
  const begun = (at: Spot) => strokeAt(brush.value, radius(), view.value, at);
  const done = () => {
    isEditing.value = false;
    // Its buttons are gone: keys go on at the picture.
    requestAnimationFrame(() => document.querySelector<HTMLElement>(".stage")?.focus({ preventScroll: true }));
  };

  useEffect(() => box.current!.focus({ preventScroll: true }), []);

  useEffect(() => {
    let stroke: Stroke | null = null;
    // With Shift the picture is moved: a mouse has but one hand.
    let moves = false;
    const follow = (event: KeyboardEvent) => (moves = event.shiftKey);
    addEventListener("keydown", follow);
    addEventListener("keyup", follow);
    // What is drawn at once is drawn again with all strokes when it ends.
    const drawFrom = (from: number) => {
      const { canvas, scale } = shownMask.value!;
      draw(canvas.getContext("2d")!, stroke!, scale, from);
      drawn.value++;
    };
    const stop = listen<Spot>(box.current!, {
      grip: (at) => (moves ? null : at),
      hover: (at) => (cursor.value = at),
      tap: (at) => {
        if (!moves) addStroke(begun(at));
      },
      dragStart: (at) => {
        stroke = begun(at);
        drawFrom(0);
      },
      drag: (_, at) => {
        stroke = extended(stroke!, toPicture(view.value, at));
        drawFrom(stroke.path.length - 2);
      },
      dragEnd: () => {
        addStroke(stroke!);
        stroke = null;
      },
      // Meant to be two fingers from the first: what it painted meanwhile goes.
      dragLost: () => {
        stroke = null;
        redrawMask();
      },
      pan,
      pinch,
    });
    return () => {
      stop();
      removeEventListener("keydown", follow);
      removeEventListener("keyup", follow);
    };
  }, [shown]);

  useEffect(() => {
    const travel = (event: KeyboardEvent) => {
      if (!event.ctrlKey && !event.metaKey) return;
      const key = event.key.toLowerCase();
      if (key !== "z" && key !== "y") return;
      strokes.value = key === "y" || event.shiftKey ? redo(strokes.value) : undo(strokes.value);
      event.preventDefault();
    };
    addEventListener("keydown", travel);
    return () => removeEventListener("keydown", travel);
  }, []);

  const { scale } = view.value;
  const at = cursor.value;
  return (
    <div class="mask-bench">
      <MaskTools brush={brush} share={share} lies={lies} onDone={done} />
      <div
        class="stage mask-stage"
        ref={box}
        tabIndex={0}
        role="application"
        aria-busy={size.value.width === 0}
        aria-label={words.stage(words.brushes[brush.value])}
        aria-describedby="mask-keys"
        onKeyDown={(event) => maskKeys(event, { lies, cursor, brush, share, dab: (spot) => addStroke(begun(spot)) })}
      >
        <StagePicture of={lies} />
        {mask && <MaskLayer mask={mask} view={view.value} size={size.value} drawn={drawn.value} label={words.shown} />}
        {at && (
          <svg class="click-layer" width={size.value.width} height={size.value.height} aria-hidden="true">
            <circle class="brush-rim" cx={at.x} cy={at.y} r={scale * radius()} />
            <circle class={`brush is-${brush.value}`} cx={at.x} cy={at.y} r={scale * radius()} />
          </svg>
        )}
        <p id="mask-keys" class="unseen">
          {words.keys}
        </p>
      </div>
    </div>
  );
}
