// Send the draft.
import { useSignal } from "@preact/signals";
import { submitFit, uploadImage } from "../api/calls";
import { problemFrom } from "../api/client";
import { UNREACHABLE, isCutOff } from "../api/connection";
import type { Problem } from "../api/types";
import { oneOf, person, picture, todo, uploaded } from "../draft/draft";
import { liveBody } from "../draft/live";
import { labelOf } from "../draft/person";
import { draftedChoices, draftedSubject } from "../draft/request";
import { uploadProblem } from "../draft/uploading";
import { assumed, remember, seen, thumbnailOf } from "../history/store";
import { maskToSend } from "../mask/edits";
import { messages } from "../messages/language";
import { fitWithPicture } from "../result/again";
import { fitAddress, go } from "../route";
import { ProblemNote } from "../ui/ProblemNote";
import { discard } from "./open";

export function SubmitBar() {
  const { frame, panel } = messages.value;
  const problem = useSignal<Problem | null>(null);
  const sending = useSignal(false);
  const send = async () => {
    const subject = draftedSubject();
    const shown = picture.value;
    if (!subject || !shown || todo.value) return;
    sending.value = true;
    problem.value = null;
    try {
      const upload = (file: Blob) => uploadImage(file, new AbortController().signal);
      const kept = uploaded.value ?? (await upload(shown.file));
      const cutOut = await maskToSend();
      const cut = cutOut && (await upload(cutOut));
      const asked = { ...subject, ...draftedChoices() };
      const called = labelOf(person.value);
      if (oneOf.value) {
        await fitWithPicture(oneOf.value, asked, called.label, cut?.id ?? null);
      } else {
        const fit = await submitFit({ ...asked, image_id: kept.id, ...called, ...(cut ? { mask_id: cut.id } : {}) });
        seen(fit);
        assumed.value = { ...assumed.value, [fit.id]: liveBody.value?.assumptions ?? [] };
        remember({ kind: fit.kind, id: fit.id, name: shown.name, startedAt: fit.created_at, thumbnail: thumbnailOf(shown.element) });
        go(fitAddress(fit));
      }
      // From here on the service has it: the next fit is another person's.
      if (picture.value === shown) discard();
    } catch (error) {
      problem.value = problemFrom(error);
      // The picture may have been erased meanwhile: the next attempt sends it anew.
      if (problem.value?.code === "unknown-image") uploaded.value = null;
    } finally {
      sending.value = false;
    }
  };
  // That nothing is reached is said for as long as it is so.
  const fault = [problem.value, uploadProblem.value].find((each) => each && each.code !== UNREACHABLE);
  return (
    <div class="submit">
      {isCutOff.value && (
        <p class="note" role="status">
          {panel.cutOff}
        </p>
      )}
      {fault && <ProblemNote problem={fault} />}
      {oneOf.value && <p class="fine">{panel.oneOfSeveral}</p>}
      <button class="button is-primary is-wide" type="button" disabled={todo.value !== null || sending.value} onClick={send}>
        {sending.value ? frame.sending : (todo.value ?? panel.submit)}
      </button>
    </div>
  );
}
