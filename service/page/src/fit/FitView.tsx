// One fit: on its way, ended without a result, or its result.
import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { cancelFit, getPicture, getRequest } from "../api/calls";
import { problemFrom } from "../api/client";
import type { Job, Problem } from "../api/types";
import { entries, forget, jobs, remember, seen, thumbnailOf } from "../history/store";
import { person } from "../draft/draft";
import { personInWords } from "../draft/person";
import { shownPicture } from "../draft/picture";
import type { Picture } from "../draft/picture";
import { wordFor } from "../messages/catalogue";
import { messages } from "../messages/language";
import { openAgain } from "../panel/open";
import { ResultView } from "../result/ResultView";
import { START_ADDRESS, go } from "../route";
import { ProblemNote } from "../ui/ProblemNote";
import { Progress } from "./Progress";
import { isActive, watch } from "./watch";

export function FitView({ id }: { id: string }) {
  const problem = useSignal<Problem | null>(null);
  const picture = useSignal<Picture | null>(null);
  const job = jobs.value[id];

  useEffect(() => {
    const leaving = new AbortController();
    problem.value = null;
    watch(id, leaving.signal).catch((error) => (problem.value = problemFrom(error)));
    return () => leaving.abort();
  }, [id]);

  const image = job?.links.image;
  useEffect(() => {
    if (!image) return undefined;
    let gone = false;
    let opened: Picture | null = null;
    Promise.all([getPicture(image), nameOf(job)])
      .then(([file, name]) => shownPicture(file, name))
      .then((shown) => {
        opened = shown;
        if (gone) return URL.revokeObjectURL(shown.url);
        picture.value = shown;
        // Opened by its link: from now on this browser knows it as well.
        remember({ id, name: shown.name, startedAt: job.created_at, thumbnail: thumbnailOf(shown.element) });
      })
      .catch((error) => (problem.value = problemFrom(error)));
    return () => {
      gone = true;
      picture.value = null;
      if (opened) URL.revokeObjectURL(opened.url);
    };
  }, [image]);

  if (problem.value) return <Trouble id={id} problem={problem.value} />;
  if (!job) return <main class="waiting" aria-busy="true" />;
  if (job.state === "succeeded") return <ResultView job={job} picture={picture.value} />;
  if (isActive(job)) {
    return <Progress job={job} picture={picture.value} onCancel={() => void cancel(job, (found) => (problem.value = found))} />;
  }
  return <Ended job={job} picture={picture.value} />;
}

/** As this browser knows it; a fit opened by its link is named by whom it shows. */
async function nameOf(job: Job): Promise<string> {
  const known = entries.value.find((entry) => entry.id === job.id);
  return known?.name ?? personInWords(await getRequest(job), person.value.units);
}

async function cancel(job: Job, fail: (problem: Problem | null) => void): Promise<void> {
  try {
    seen(await cancelFit(job.id));
  } catch (error) {
    fail(problemFrom(error));
  }
}

function Trouble({ id, problem }: { id: string; problem: Problem }) {
  const { fit, frame } = messages.value;
  const gone = problem.status === 404 || problem.status === 410;
  return (
    <main class="ended">
      <h1>{gone ? fit.gone : fit.notShown}</h1>
      <ProblemNote problem={problem} />
      <div class="row">
        <button class="button is-primary" type="button" onClick={() => go(START_ADDRESS)}>
          {fit.startAnother}
        </button>
        {gone ? (
          <button
            class="button"
            type="button"
            onClick={() => {
              forget(id);
              go(START_ADDRESS);
            }}
          >
            {fit.forget}
          </button>
        ) : (
          <button class="button" type="button" onClick={() => location.reload()}>
            {frame.tryAgain}
          </button>
        )}
      </div>
    </main>
  );
}

function Ended({ job, picture }: { job: Job; picture: Picture | null }) {
  const { fit } = messages.value;
  return (
    <main class="ended">
      {picture && <img class="ended-picture" src={picture.url} alt={fit.picture} />}
      <h1>{wordFor(fit.endings, job.state)}</h1>
      {job.problem && <ProblemNote problem={job.problem} />}
      <div class="row">
        {picture && (
          <button
            class="button is-primary"
            type="button"
            onClick={() => openAgain(picture, job)}
          >
            {fit.changeAndRetry}
          </button>
        )}
        <button class="button" type="button" onClick={() => go(START_ADDRESS)}>
          {fit.startAnother}
        </button>
      </div>
    </main>
  );
}
