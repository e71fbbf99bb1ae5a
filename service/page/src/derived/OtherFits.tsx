// The other fits of this browser that may be of the same person, to be ticked.
import { useEffect, useState } from "preact/hooks";
import { getFit, getRequest } from "../api/calls";
import { ProblemError } from "../api/client";
import type { FitOptions, Job, Scan } from "../api/types";
import { isActive } from "../fit/watch";
import { entries, jobs, seen } from "../history/store";
import type { Entry } from "../history/store";
import { LIMITS } from "../api/limits";
import { moment } from "../messages/figures";
import { messages } from "../messages/language";
import { toldAlike } from "./sameperson";

interface Props {
  readonly fit: Job | Scan;
  readonly chosen: readonly string[];
  readonly onChoose: (fits: readonly string[]) => void;
}

export function OtherFits({ fit, chosen, onChoose }: Props) {
  const { combined } = messages.value.derived;
  const { found, searching } = useOtherFits(fit);
  return (
    <fieldset class="others" aria-busy={searching}>
      <legend class="unseen">{combined.others}</legend>
      {found.map(({ id, name, startedAt, thumbnail }) => {
        const isChosen = chosen.includes(id);
        return (
          <label key={id} class="check">
            <input
              type="checkbox"
              checked={isChosen}
              disabled={!isChosen && chosen.length >= LIMITS.otherFits}
              onChange={() => onChoose(isChosen ? chosen.filter((each) => each !== id) : [...chosen, id])}
            />
            <img src={thumbnail} alt="" />
            <span>
              {name} <small>{moment(startedAt)}</small>
            </span>
          </label>
        );
      })}
      <p class="fine">
        {found.length > 0 ? combined.tick : searching ? combined.searching : combined.none}
      </p>
    </fieldset>
  );
}

/** Finished fits that were told the same gender and height, newest first; they come one by one. */
function useOtherFits(fit: Job | Scan): { found: readonly Entry[]; searching: boolean } {
  const [found, setFound] = useState<readonly Entry[]>([]);
  const [searching, setSearching] = useState(true);
  useEffect(() => {
    let gone = false;
    const search = async () => {
      const own = await getRequest(fit);
      for (const entry of entries.value) {
        if (gone) return;
        if (entry.scan || entry.id === fit.id) continue;
        const told = await toldOf(entry.id);
        if (!gone && told && toldAlike(own, told)) setFound((old) => [...old, entry]);
      }
    };
    void search()
      .catch(() => undefined)
      .finally(() => gone || setSearching(false));
    return () => {
      gone = true;
    };
  }, [fit.id]);
  return { found, searching };
}

/** What a finished fit was told; null of one that has no result, or is gone. */
async function toldOf(id: string): Promise<FitOptions | null> {
  try {
    const known = jobs.value[id];
    const job = known && !isActive(known) ? known : await getFit(id);
    if (job !== known) seen(job);
    return job.state === "succeeded" ? await getRequest(job) : null;
  } catch (error) {
    if (error instanceof ProblemError) return null;
    throw error;
  }
}
