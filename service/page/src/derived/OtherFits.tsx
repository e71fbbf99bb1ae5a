// The other fits of this browser that may be of the same person, to be ticked.
import { useEffect, useState } from "preact/hooks";
import { getAsked, getFit } from "../api/calls";
import { ProblemError } from "../api/client";
import type { Asked, Fit, FitRef } from "../api/fits";
import { isActive } from "../fit/watch";
import { entries, fits, seen } from "../history/store";
import type { Entry } from "../history/store";
import { LIMITS } from "../api/limits";
import { moment } from "../messages/figures";
import { messages } from "../messages";
import { toldAlike } from "./sameperson";

interface Props {
  readonly fit: Fit;
  readonly chosen: readonly string[];
  readonly onChoose: (fits: readonly string[]) => void;
}

export function OtherFits({ fit, chosen, onChoose }: Props) {
  const { combined } = messages.derived;
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

/** Finished ones of its kind that were told the same gender and height, newest first; they come one by one. */
function useOtherFits(fit: Fit): { found: readonly Entry[]; searching: boolean } {
  const [found, setFound] = useState<readonly Entry[]>([]);
  const [searching, setSearching] = useState(true);
  useEffect(() => {
    let gone = false;
    const search = async () => {
      const own = await getAsked(fit);
      for (const entry of entries.value) {
        if (gone) return;
        if (entry.kind !== fit.kind || entry.id === fit.id) continue;
        const told = await toldOf(entry);
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
async function toldOf(which: FitRef): Promise<Asked | null> {
  try {
    const known = fits.value[which.id];
    const fit = known && !isActive(known) ? known : await getFit(which);
    if (fit !== known) seen(fit);
    return fit.state === "succeeded" ? await getAsked(fit) : null;
  } catch (error) {
    if (error instanceof ProblemError) return null;
    throw error;
  }
}
