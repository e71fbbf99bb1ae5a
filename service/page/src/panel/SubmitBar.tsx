// Send the draft.
import { useSignal } from "@preact/signals";
import { submitFit, uploadImage } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Problem } from "../api/types";
import { mask, picture, todo, uploaded } from "../draft/draft";
import { liveBody, uploadProblem } from "../draft/live";
import { draftedChoices, draftedSubject } from "../draft/request";
import { assumed, remember, seen, thumbnailOf } from "../history/store";
import { fitAddress, go } from "../route";
import { ProblemNote } from "../ui/ProblemNote";

export function SubmitBar() {
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
      const cut = mask.value && (await upload(mask.value.file));
      const job = await submitFit({
        ...subject,
        image_id: kept.id,
        ...draftedChoices(),
        ...(cut ? { mask_id: cut.id } : {}),
      });
      seen(job);
      assumed.value = { ...assumed.value, [job.id]: liveBody.value?.assumptions ?? [] };
      remember({ id: job.id, name: shown.name, startedAt: job.created_at, thumbnail: thumbnailOf(shown.element) });
      go(fitAddress(job.id));
    } catch (error) {
      problem.value = problemFrom(error);
      // The picture may have been erased meanwhile: the next attempt sends it anew.
      if (problem.value?.code === "unknown-image") uploaded.value = null;
    } finally {
      sending.value = false;
    }
  };
  const fault = problem.value ?? uploadProblem.value;
  return (
    <div class="submit">
      {fault && <ProblemNote problem={fault} />}
      <button class="button is-primary is-wide" type="button" disabled={todo.value !== null || sending.value} onClick={send}>
        {sending.value ? "Sending …" : (todo.value ?? "Fit the body")}
      </button>
    </div>
  );
}
