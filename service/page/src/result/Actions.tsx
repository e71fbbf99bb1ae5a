// What can be done with a finished fit: keep its link, change it, erase it.
import { useSignal } from "@preact/signals";
import { eraseFit } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Job, Problem } from "../api/types";
import type { Picture } from "../draft/picture";
import { forget } from "../history/store";
import { openAgain } from "../panel/open";
import { go } from "../route";
import { announce } from "../ui/announce";
import { IconButton } from "../ui/IconButton";
import { ProblemNote } from "../ui/ProblemNote";

const COPIED_MS = 2000;

export function Actions({ job, picture }: { job: Job; picture: Picture | null }) {
  const problem = useSignal<Problem | null>(null);
  const copied = useSignal(false);
  const asked = useSignal(false);
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
      announce("The link is copied.");
      copied.value = true;
      setTimeout(() => (copied.value = false), COPIED_MS);
    });
  const erase = () =>
    attempt(async () => {
      await eraseFit(job.id);
      forget(job.id);
      go("#/");
    });
  return (
    <div class="submit">
      {problem.value && <ProblemNote problem={problem.value} />}
      {asked.value ? (
        <div class="submit-row" role="group" aria-label="Delete this fit?">
          <span class="grow">Erase this fit with its picture?</span>
          <button class="button" type="button" onClick={() => (asked.value = false)}>
            Keep
          </button>
          <button class="button is-danger" type="button" onClick={erase}>
            Delete
          </button>
        </div>
      ) : (
        <div class="submit-row">
          <button
            class="button is-primary grow"
            type="button"
            disabled={!picture}
            onClick={() => attempt(async () => openAgain(picture!, job))}
          >
            Change and fit again
          </button>
          <IconButton icon={copied.value ? "check" : "link"} label={copied.value ? "Copied" : "Copy the link to this fit"} onClick={copy} />
          <IconButton icon="trash" label="Delete this fit" onClick={() => (asked.value = true)} />
        </div>
      )}
    </div>
  );
}
