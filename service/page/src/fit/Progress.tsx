// A fit on its way: its stages, and its energies as they go down.
import { useState } from "preact/hooks";
import { getRequest } from "../api/calls";
import type { Job } from "../api/types";
import type { Picture } from "../draft/picture";
import { assumed } from "../history/store";
import { percent } from "../messages/figures";
import { messages } from "../messages/language";
import { AssumptionNotes } from "../ui/AssumptionNotes";
import { useAsked } from "../ui/asked";
import { EnergyChart } from "./EnergyChart";
import { STAGES } from "./stages";
import { readings } from "./watch";

interface Props {
  readonly job: Job;
  readonly picture: Picture | null;
  readonly onCancel: () => void;
}

export function Progress({ job, picture, onCancel }: Props) {
  const { fit } = messages.value;
  const [stopping, setStopping] = useState(job.cancel_requested);
  const asked = useAsked(job.id, () => getRequest(job));
  const list = readings.value[job.id] ?? [];
  const at = STAGES.findIndex((stage) => stage === job.stage);
  return (
    <main class="bench">
      <div class="bench-stage is-quiet">{picture && <img class="whole-picture" src={picture.url} alt={fit.picture} />}</div>
      <div class="panel">
        <div class="panel-scroll">
          <section class="section">
            <h1 class="title">{job.state === "queued" ? fit.queued : fit.running}</h1>
            <progress class="bar" max={1} value={job.progress} aria-label={fit.progress}>
              {percent(job.progress)}
            </progress>
            <AssumptionNotes assumptions={assumed.value[job.id] ?? []} asked={asked?.points ?? null} />
            <ol class="stages">
              {STAGES.map((stage, i) => (
                <li key={stage} class={i < at ? "is-done" : i === at ? "is-current" : ""} aria-current={i === at ? "step" : undefined}>
                  <b>{fit.stages[stage].label}</b>
                  <span>{fit.stages[stage].help}</span>
                </li>
              ))}
            </ol>
          </section>
          <section class="section">
            <h2>{fit.misfit.title}</h2>
            <p class="fine">{fit.misfit.help}</p>
            <EnergyChart readings={list} />
          </section>
        </div>
        <div class="submit">
          <button
            class="button is-wide"
            type="button"
            disabled={stopping}
            onClick={() => {
              setStopping(true);
              onCancel();
            }}
          >
            {stopping ? fit.stopping : fit.cancel}
          </button>
        </div>
      </div>
    </main>
  );
}
