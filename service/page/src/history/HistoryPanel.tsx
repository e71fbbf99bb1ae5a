// This browser's fits, newest first, each where it stands.
import { useEffect, useRef } from "preact/hooks";
import { getFit } from "../api/calls";
import { ProblemError } from "../api/client";
import { person } from "../draft/draft";
import { inches } from "../draft/person";
import type { Person } from "../draft/person";
import { isActive } from "../fit/watch";
import { measured, moment, percent } from "../messages/figures";
import { messages } from "../messages";
import { fitAddress, go, openFit } from "../route";
import { IconButton } from "../ui/IconButton";
import { entries, fits, forget, seen } from "./store";
import type { Entry } from "./store";

const LOOK_EVERY_MS = 2000;

export function HistoryPanel({ onClose }: { onClose: () => void }) {
  const { frame } = messages;
  const { units } = person.value;
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => dialog.current!.showModal(), []);
  useEffect(() => {
    let gone = false;
    const look = async () => {
      for (const entry of entries.value) {
        const known = fits.value[entry.id];
        if (gone || (known && !isActive(known))) continue;
        try {
          seen(await getFit(entry.id));
        } catch (error) {
          if (error instanceof ProblemError && error.problem.status === 404) forget(entry.id);
        }
      }
    };
    void look();
    const timer = setInterval(() => void look(), LOOK_EVERY_MS);
    return () => {
      gone = true;
      clearInterval(timer);
    };
  }, []);
  return (
    <dialog
      ref={dialog}
      class="drawer"
      aria-labelledby="history-title"
      onClose={onClose}
      onClick={(event) => event.target === dialog.current && dialog.current!.close()}
    >
      <div class="drawer-inside">
        <header class="section-head">
          <h2 id="history-title">{frame.list.title}</h2>
          <IconButton icon="close" label={frame.close} onClick={() => dialog.current!.close()} />
        </header>
        {entries.value.length === 0 && <p class="fine">{frame.list.none}</p>}
        <ul class="history">
          {entries.value.map((entry) => (
            <li key={entry.id} class={openFit.value === entry.id ? "is-open" : ""}>
              <a
                href={fitAddress(entry.id)}
                onClick={(event) => {
                  event.preventDefault();
                  go(fitAddress(entry.id));
                  dialog.current!.close();
                }}
              >
                <img src={entry.thumbnail} alt="" width="48" height="64" />
                <span>
                  <b>{entry.name}</b>
                  <small>{moment(entry.startedAt)}</small>
                  <small>{standing(entry, units)}</small>
                </span>
              </a>
              <IconButton icon="close" label={frame.list.takeOff(entry.name)} onClick={() => forget(entry.id)} />
            </li>
          ))}
        </ul>
        <p class="fine">{frame.list.note}</p>
      </div>
    </dialog>
  );
}

function standing({ id, waistCm }: Entry, units: Person["units"]): string {
  const fit = fits.value[id];
  const { list } = messages.frame;
  if (waistCm !== undefined) return list.waist(units === "metric" ? measured(waistCm, "centimeter", 1) : measured(inches(waistCm), "inch", 1));
  if (!fit) return "…";
  if (fit.state === "running") return `${list.states.running} ${percent(fit.progress)}`;
  return list.states[fit.state];
}
