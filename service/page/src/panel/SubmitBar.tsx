// Send the draft.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { submitFit, uploadImage } from "../api/calls";
import { problemFrom } from "../api/client";
import { UNREACHABLE, isCutOff } from "../api/connection";
import type { Problem, ViewRequest } from "../api/types";
import { person, todo, views } from "../draft/draft";
import type { DraftView } from "../draft/draft";
import { discard } from "../draft/open";
import { viewRequest, wholeRequest } from "../draft/request";
import { remember, seen, thumbnailOf } from "../history/store";
import { maskToSend } from "../mask/edits";
import { messages } from "../messages";
import { fitAddress, go } from "../route";
import { ProblemNote } from "../ui/ProblemNote";

export function SubmitBar() {
  const { frame, panel } = messages;
  const problem = useSignal<Problem | null>(null);
  const sending = useSignal(false);
  const send = async () => {
    const { gender } = person.value;
    const sent = views.value;
    if (gender === null || todo.value !== null) return;
    sending.value = true;
    problem.value = null;
    try {
      const fit = await submitFit({ ...wholeRequest(gender), views: await Promise.all(sent.map(uploadedView)) });
      const { name, element } = sent[0]!.picture;
      seen(fit);
      remember({ id: fit.id, name, startedAt: fit.created_at, thumbnail: thumbnailOf(element) });
      go(fitAddress(fit.id));
      // From here on the service has it: the next fit is another person's.
      if (views.value === sent) discard();
    } catch (error) {
      problem.value = problemFrom(error);
      // A picture may have been erased meanwhile: the next attempt sends all anew.
      if (problem.value && isErased(problem.value)) for (const { uploaded } of sent) uploaded.value = null;
    } finally {
      sending.value = false;
    }
  };
  // Enter in a field of the person is the button.
  useEffect(() => {
    const listen = ({ key, target }: KeyboardEvent) => {
      if (key === "Enter" && target instanceof HTMLInputElement && target.inputMode === "decimal" && !sending.value) void send();
    };
    addEventListener("keydown", listen);
    return () => removeEventListener("keydown", listen);
  });
  return (
    <div class="submit">
      {isCutOff.value && (
        <p class="note" role="status">
          {panel.cutOff}
        </p>
      )}
      {/* That nothing is reached is said for as long as it is so. */}
      {problem.value && problem.value.code !== UNREACHABLE && <ProblemNote problem={problem.value} />}
      <button class="button is-primary is-wide" type="button" disabled={todo.value !== null || sending.value} onClick={() => void send()}>
        {sending.value ? frame.sending : (todo.value ?? panel.submit)}
      </button>
    </div>
  );
}

/** A picture as it is asked for, with the ids of its files. */
async function uploadedView(view: DraftView): Promise<ViewRequest> {
  const { picture, uploaded } = view;
  uploaded.value ??= await uploadImage(picture.file);
  const mask = await maskToSend(view);
  return { ...viewRequest(view), image_id: uploaded.value.id, ...(mask ? { mask_id: (await uploadImage(mask)).id } : {}) };
}

function isErased({ code, errors }: Problem): boolean {
  return [code, ...(errors ?? []).map((error) => error.code)].includes("unknown-image");
}
