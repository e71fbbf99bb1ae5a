// This browser's fits and scans, newest first, each where it stands.
import { useEffect, useRef } from "preact/hooks";
import { getFit, getScan } from "../api/calls";
import { ProblemError } from "../api/client";
import type { Job, Scan } from "../api/types";
import { stageLabel } from "../fit/stages";
import { isActive } from "../fit/watch";
import { scans, seenScan } from "../measure/watch";
import { fitAddress, go, openFit, openScan, scanAddress } from "../route";
import { IconButton } from "../ui/IconButton";
import { entries, forget, jobs, seen } from "./store";
import type { Entry } from "./store";

const LOOK_EVERY_MS = 2000;

export function HistoryPanel({ onClose }: { onClose: () => void }) {
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
          <h2 id="history-title">Fits and scans of this browser</h2>
          <IconButton icon="close" label="Close" onClick={() => dialog.current!.close()} />
        </header>
        {entries.value.length === 0 && <p class="fine">None yet.</p>}
        <ul class="history">
          {entries.value.map((entry) => (
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
                  <small>{new Date(entry.startedAt).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" })}</small>
                  <small>{standing(entry)}</small>
                </span>
              </a>
              <IconButton icon="close" label={`Take ${entry.name} off this list`} onClick={() => forget(entry.id)} />
            </li>
          ))}
        </ul>
        <p class="fine">Only this browser knows the list. The service erases them after a while; deleting one erases it at once.</p>
      </div>
    </dialog>
  );
}

const STATES: Readonly<Record<string, string>> = {
  queued: "Waiting",
  succeeded: "Done",
  failed: "Failed",
  canceled: "Canceled",
  timed_out: "Took too long",
};

function jobOf({ id, scan }: Entry): Job | Scan | undefined {
  return scan ? scans.value[id] : jobs.value[id];
}

function addressOf({ id, scan }: Entry): string {
  return scan ? scanAddress(id) : fitAddress(id);
}

function standing(entry: Entry): string {
  const job = jobOf(entry);
  if (!job) return "…";
  if (job.state === "running") return `${stageLabel(job.stage ?? "observation")}, ${Math.round(100 * job.progress)} %`;
  return STATES[job.state] ?? job.state;
}
