// What can be done with a finished fit: correct it, keep its link, erase it.
import { useSignal } from "@preact/signals";
import { eraseFit } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Fit, Problem } from "../api/types";
import { openAgain } from "../draft/open";
import type { Picture } from "../draft/picture";
import { forget } from "../history/store";
import { messages } from "../messages";
import { START_ADDRESS, go } from "../route";
import { announce } from "../ui/announce";
import { IconButton } from "../ui/IconButton";
import { ProblemNote } from "../ui/ProblemNote";
import { useQuestion } from "../ui/question";

const COPIED_MS = 2000;

export function Actions({ fit, pictures }: { fit: Fit; pictures: readonly Picture[] }) {
  const { result: words } = messages;
  const problem = useSignal<Problem | null>(null);
  const copied = useSignal(false);
  const question = useQuestion();
  const attempt = async (what: () => Promise<void>) => {
    try {
      await what();
      problem.value = null;
    } catch (error) {
      problem.value = problemFrom(error);
    }
  };
  const copy = () =>
    attempt(async () => {
      await navigator.clipboard.writeText(location.href);
      announce(words.linkCopied);
      copied.value = true;
      setTimeout(() => (copied.value = false), COPIED_MS);
    });
  const erase = () =>
    attempt(async () => {
      await eraseFit(fit.id);
      forget(fit.id);
      go(START_ADDRESS);
    });
  return (
    <div class="submit">
      {problem.value && <ProblemNote problem={problem.value} />}
      {question.isAsked ? (
        <div class="submit-row" role="group" aria-label={words.deleteQuestion}>
          <span class="grow">{words.deleteQuestion}</span>
          <button class="button" type="button" ref={question.refusal} onClick={question.leave}>
            {words.keep}
          </button>
          <button class="button is-danger" type="button" onClick={erase}>
            {words.delete}
          </button>
        </div>
      ) : (
        <div class="submit-row">
          <button class="button grow" type="button" disabled={pictures.length === 0} onClick={() => attempt(() => openAgain(fit, 0, pictures))}>
            {words.again}
          </button>
          <IconButton icon={copied.value ? "check" : "link"} label={copied.value ? words.copied : words.copy} onClick={copy} />
          <IconButton icon="trash" label={words.deleteFit} onClick={question.ask} buttonRef={question.asker} />
        </div>
      )}
    </div>
  );
}
