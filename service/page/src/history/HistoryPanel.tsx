// This browser's fits and scans, newest first, each where it stands.
import { useEffect, useRef, useState } from "preact/hooks";
import { getFit, getScan } from "../api/calls";
import { ProblemError } from "../api/client";
import type { Job, Scan } from "../api/types";
import { stageLabel } from "../fit/stages";
import { isActive } from "../fit/watch";
import { scans, seenScan } from "../measure/watch";
import { moment, percent } from "../messages/figures";
import { messages } from "../messages/language";
import { fitAddress, go, openFit, openScan, scanAddress } from "../route";
import { IconButton } from "../ui/IconButton";
import { PersonFilter } from "./PersonFilter";
import { entries, forget, jobs, seen } from "./store";
import type { Entry } from "./store";

const LOOK_EVERY_MS = 2000;

export function HistoryPanel({ onClose }: { onClose: () => void }) {
  const { frame, people } = messages.value;
  const [whose, setWhose] = useState<string | null>(null);
  const shown = entries.value.filter((entry) => whose === null || jobOf(entry)?.label === whose);
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => dialog.current!.showModal(), []);
  useEffect(() => {
    let gone = false;
    const look = async () => {
      for (const entry of entries.value) {
        const known = jobOf(entry);
        if (gone || (known && !isActive(known))) continue;
        try {
          if (entry.scan) seenScan(await getScan(entry.id));
          else seen(await getFit(entry.id));
        } catch (error) {
          if (error instanceof ProblemError && [404, 410].includes(error.problem.status)) forget(entry.id);
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
        <PersonFilter
          labels={entries.value.flatMap((entry) => jobOf(entry)?.label ?? [])}
          chosen={whose}
          onChoose={setWhose}
          onLeave={() => dialog.current!.close()}
        />
        {whose !== null && shown.length === 0 && <p class="fine">{people.noneHere}</p>}
        <ul class="history">
          {shown.map((entry) => (
            <li key={entry.id} class={(openFit.value ?? openScan.value) === entry.id ? "is-open" : ""}>
              <a
                href={addressOf(entry)}
                onClick={(event) => {
                  event.preventDefault();
                  go(addressOf(entry));
                  dialog.current!.close();
                }}
              >
                <img src={entry.thumbnail} alt="" width="48" height="64" />
                <span>
                  <b>{entry.name}</b>
                  {jobOf(entry)?.label && <small>{jobOf(entry)!.label}</small>}
                  <small>{moment(entry.startedAt)}</small>
                  <small>{standing(entry)}</small>
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

function jobOf({ id, scan }: Entry): Job | Scan | undefined {
  return scan ? scans.value[id] : jobs.value[id];
}

function addressOf({ id, scan }: Entry): string {
  return scan ? scanAddress(id) : fitAddress(id);
}

function standing(entry: Entry): string {
  const job = jobOf(entry);
  if (!job) return "…";
  const { list } = messages.value.frame;
  if (job.state === "running") return list.running(stageLabel(job.stage ?? "observation"), percent(job.progress));
  return list.states[job.state];
}
