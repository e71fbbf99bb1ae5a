// What a mask is edited with, beside the picture.
import type { Signal } from "@preact/signals";
import { strokes } from "../draft/draft";
import { decimal } from "../messages/figures";
import { messages } from "../messages";
import { redo, undo } from "../points/timeline";
import type { PictureView } from "../stage/pictureView";
import { ViewButtons } from "../stage/ViewButtons";
import { Choice } from "../ui/Choice";
import { IconButton } from "../ui/IconButton";
import { isEdited, resetMask } from "./edits";
import { shareOf, sliderOf } from "./strokes";
import type { Brush } from "./strokes";

interface Props {
  readonly brush: Signal<Brush>;
  readonly share: Signal<number>;
  readonly lies: PictureView;
  readonly onDone: () => void;
}

export function MaskTools({ brush, share, lies, onDone }: Props) {
  const { mask: words } = messages;
  const { past, future } = strokes.value;
  return (
    <div class="mask-tools" role="toolbar" aria-label={words.tools}>
      <Choice
        name="brush"
        legend={words.brush}
        quiet
        options={[
          { value: "add", label: words.brushes.add },
          { value: "remove", label: words.brushes.remove },
        ]}
        value={brush.value}
        onChange={(value) => (brush.value = value)}
      />
      <label class="mask-size">
        <span>{words.size}</span>
        <input
          type="range"
          min={0}
          max={100}
          step={1}
          value={sliderOf(share.value)}
          aria-valuetext={decimal(sliderOf(share.value))}
          onInput={(event) => (share.value = shareOf(event.currentTarget.valueAsNumber))}
        />
      </label>
      <div class="mask-buttons">
        <IconButton icon="undo" label={words.undo} disabled={past.length === 0} onClick={() => (strokes.value = undo(strokes.value))} />
        <IconButton icon="redo" label={words.redo} disabled={future.length === 0} onClick={() => (strokes.value = redo(strokes.value))} />
        <IconButton icon="again" label={words.reset} disabled={!isEdited.value} onClick={resetMask} />
        <ViewButtons of={lies} />
      </div>
      <button class="button is-small is-primary" type="button" onClick={onDone}>
        {words.done}
      </button>
    </div>
  );
}
