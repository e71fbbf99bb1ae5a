// The mask before the fit, small beside the picture, and the way to its brushes.
import { useLayoutEffect, useMemo, useRef } from "preact/hooks";
import { current, mask } from "../draft/draft";
import { messages } from "../messages";
import type { Size, View } from "../stage/view";
import { isEdited, isEditing, resetMask, shownMask } from "./edits";
import { MaskLayer } from "./MaskLayer";

const PREVIEW: Size = { width: 96, height: 128 };

export function MaskSection() {
  const { mask: words } = messages;
  const shown = shownMask.value;
  if (!shown) return null;
  const state = isEdited.value ? words.edited : mask.value ? words.chosen : words.proposed;
  return (
    <section class="section" aria-labelledby="mask-title">
      <header class="section-head">
        <h2 id="mask-title">{words.title}</h2>
        <span class="count">{state}</span>
      </header>
      <div class="mask-line">
        <Preview />
        <div class="mask-text">
          <p class="fine">{isEdited.value ? words.editedHelp : words.help}</p>
          <div class="row">
            <button class="button is-small" type="button" aria-pressed={isEditing.value} onClick={() => (isEditing.value = !isEditing.value)}>
              {isEditing.value ? words.done : words.edit}
            </button>
            {isEdited.value && (
              <button class="button is-small" type="button" onClick={resetMask}>
                {words.reset}
              </button>
            )}
          </div>
        </div>
      </div>
    </section>
  );
}

function Preview() {
  const shown = current.value!.picture;
  const canvas = useRef<HTMLCanvasElement>(null);
  const view = useMemo(() => filled(shown), [shown]);
  useLayoutEffect(() => {
    const target = canvas.current;
    if (!target) return;
    const ratio = window.devicePixelRatio || 1;
    target.width = ratio * PREVIEW.width;
    target.height = ratio * PREVIEW.height;
    const { scale, x, y } = view;
    target
      .getContext("2d")!
      .drawImage(shown.element, ratio * x, ratio * y, ratio * scale * shown.width, ratio * scale * shown.height);
  }, [view]);
  return (
    <div class="mask-preview">
      <canvas ref={canvas} aria-hidden="true" />
      <MaskLayer mask={shownMask.value!} view={view} size={PREVIEW} label={messages.mask.preview} />
    </div>
  );
}

/** The whole picture, as large as there is room. */
function filled({ width, height }: Size): View {
  const scale = Math.min(PREVIEW.width / width, PREVIEW.height / height);
  return { scale, x: (PREVIEW.width - scale * width) / 2, y: (PREVIEW.height - scale * height) / 2 };
}
