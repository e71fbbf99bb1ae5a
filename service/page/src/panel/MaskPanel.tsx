// The person cut out beforehand, for those who have a mask.
import { useSignal } from "@preact/signals";
import { mask, picture, useMask } from "../draft/draft";
import { openPicture } from "../draft/chosen";
import { messages } from "../messages";
import { sizeOf } from "./size";

export function MaskPanel() {
  const { mask: words } = messages.panel;
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
      <h3>{words.title}</h3>
      <p class="fine">
        {chosen ? words.used(chosen.name) : words.help}
      </p>
      <div class="row">
        <label class="button is-small">
          {chosen ? words.another : words.choose}
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
            {words.leave}
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
  return messages.panel.mask.misfit(sizeOf(cut), sizeOf(shown));
}
