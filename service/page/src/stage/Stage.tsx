// The picture with its points: where a person clicks.
import { untracked, useSignal, useSignalEffect } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { adjust, current, isCorrecting, mask, points, selected, timeline, upcoming } from "../draft/draft";
import { looked, proposalWord } from "../draft/proposing";
import { isEdited, shownMask } from "../mask/edits";
import { MaskLayer } from "../mask/MaskLayer";
import { messages } from "../messages";
import type { PointName } from "../points/catalogue";
import { place } from "../points/placed";
import { hasProposed } from "../points/proposed";
import { advance } from "../points/timeline";
import { ClickLayer } from "./ClickLayer";
import { PersonBoxes } from "./PersonBoxes";
import { StagePicture } from "./StagePicture";
import { StageTools } from "./StageTools";
import { listen } from "./gestures";
import { stageKeys, timeTravel } from "./keys";
import { Loupe } from "./Loupe";
import { usePictureView } from "./pictureView";
import { nearest, tap } from "./placing";
import { inside, toPicture, toStage } from "./view";
import type { Spot } from "./view";

const GRIP_PX = { mouse: 10, touch: 22 };

export function Stage() {
  const { points: words, stage } = messages;
  const shown = current.value!.picture;
  const lies = usePictureView(shown, looked.value);
  const { box, size, view, pan, pinch } = lies;
  const aim = useSignal<{ at: Spot; touch: boolean } | null>(null);
  const dragged = useSignal<PointName | null>(null);

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
        dragLost: () => (dragged.value = null),
        pan,
        pinch,
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
    if (dx || dy) untracked(() => pan(dx, dy));
  });

  const name = upcoming.value;
  return (
    <div class="stage-bench">
      <div
        class={`stage ${dragged.value ? "is-dragging" : name ? "is-placing" : ""}`}
        ref={box}
        tabIndex={0}
        role="application"
        aria-busy={size.value.width === 0}
        aria-label={stage.label(name ? stage.next(words.labels[name]) : hasProposed(points.value) ? stage.allProposed : stage.allPlaced)}
        aria-describedby="stage-keys"
        onKeyDown={(event) => stageKeys(event, { lies, aim })}
      >
        <StagePicture of={lies} />
        {shownMask.value && (mask.value || isEdited.value) && (
          <MaskLayer mask={shownMask.value} view={view.value} size={size.value} isTinted={false} label={stage.maskBorder} />
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
        <p id="stage-keys" class="unseen">
          {stage.keys}
        </p>
      </div>
      {isCorrecting.value && <StageTools lies={lies} />}
    </div>
  );
}
