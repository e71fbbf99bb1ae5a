// Send the draft.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { submitFit, uploadImage } from "../api/calls";
import { problemFrom } from "../api/client";
import { UNREACHABLE, isCutOff } from "../api/connection";
import type { Problem } from "../api/types";
import { oneOf, picture, todo, uploaded } from "../draft/draft";
import { liveBody } from "../draft/live";
import { isProposing } from "../draft/proposing";
import { draftedChoices, draftedSubject } from "../draft/request";
import { uploadProblem } from "../draft/uploading";
import { assumed, remember, seen, thumbnailOf } from "../history/store";
import { maskToSend } from "../mask/edits";
import { messages } from "../messages";
import { fitWithPicture } from "../result/again";
import { fitAddress, go } from "../route";
import { ProblemNote } from "../ui/ProblemNote";
import { discard } from "./open";

export function SubmitBar() {
  const { frame, panel, person: { todo: missing } } = messages;
  const problem = useSignal<Problem | null>(null);
  const sending = useSignal(false);
  /** Somebody wants the fit as soon as the points are there. */
  const isEager = useSignal(false);
  const waits = todo.value === missing.points && isProposing.value;
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
      if (oneOf.value) {
        await fitWithPicture(oneOf.value, asked, cut?.id ?? null);
      } else {
        const fit = await submitFit({ ...asked, image_id: kept.id, ...(cut ? { mask_id: cut.id } : {}) });
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
  const begin = () => {
    if (waits) isEager.value = true;
    else void send();
  };
  useEffect(() => {
    if (!isEager.value || waits) return;
    isEager.value = false;
    void send();
  }, [isEager.value, waits]);
  // Enter in a field of the person is the button.
  useEffect(() => {
    const listen = ({ key, target }: KeyboardEvent) => {
      if (key === "Enter" && target instanceof HTMLInputElement && target.inputMode === "decimal" && !sending.value) begin();
    };
    addEventListener("keydown", listen);
    return () => removeEventListener("keydown", listen);
  });
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
      <button class="button is-primary is-wide" type="button" disabled={(todo.value !== null && !waits) || sending.value || isEager.value} onClick={begin}>
        {sending.value ? frame.sending : isEager.value ? panel.finding : waits ? panel.submit : (todo.value ?? panel.submit)}
      </button>
    </div>
  );
}
