// The person cut out beforehand, for those who have a mask.
import { useSignal } from "@preact/signals";
import { mask, picture, useMask } from "../draft/draft";
import { openPicture } from "../draft/picture";

export function MaskPanel() {
  const fault = useSignal<string | null>(null);
  const chosen = mask.value;
  const open = async (file: File) => {
    try {
      const cut = await openPicture(file, file.name);
      fault.value = misfit(cut);
      if (fault.value === null) useMask(cut);
      else URL.revokeObjectURL(cut.url);
    } catch (error) {
      fault.value = (error as Error).message;
    }
  };
  return (
    <div class="subsection">
      <h3>Mask</h3>
      <p class="fine">
        {chosen
          ? `${chosen.name} is used; its border is drawn on the picture.`
          : "The fit cuts the person out of the picture by itself. A mask of your own, white on the person, is used instead."}
      </p>
      <div class="row">
        <label class="button is-small">
          {chosen ? "Another mask" : "Choose a mask"}
          <input
            class="unseen"
            type="file"
            accept="image/*"
            onChange={(event) => {
              const file = event.currentTarget.files?.[0];
              event.currentTarget.value = "";
              if (file) void open(file);
            }}
          />
        </label>
        {chosen && (
          <button class="button is-small" type="button" onClick={() => useMask(null)}>
            Leave it to the fit
          </button>
        )}
      </div>
      {fault.value && (
        <p class="note is-problem" role="alert">
          {fault.value}
        </p>
      )}
    </div>
  );
}

function misfit(cut: { width: number; height: number }): string | null {
  const shown = picture.value!;
  if (cut.width === shown.width && cut.height === shown.height) return null;
  return `The mask has ${cut.width} × ${cut.height} pixels, the picture ${shown.width} × ${shown.height}. Make them the same size.`;
}
