// A fit on its way: its stages, and its energies as they go down.
import { useState } from "preact/hooks";
import type { Job } from "../api/types";
import type { Picture } from "../draft/picture";
import { assumed } from "../history/store";
import { AssumptionNotes } from "../ui/AssumptionNotes";
import { EnergyChart } from "./EnergyChart";
import { STAGES } from "./stages";
import { readings } from "./watch";

interface Props {
  readonly job: Job;
  readonly picture: Picture | null;
  readonly onCancel: () => void;
}

export function Progress({ job, picture, onCancel }: Props) {
  const [stopping, setStopping] = useState(job.cancel_requested);
  const list = readings.value[job.id] ?? [];
  const at = STAGES.findIndex((stage) => stage.name === job.stage);
  const percent = Math.round(100 * job.progress);
  return (
    <main class="bench">
      <div class="bench-stage is-quiet">{picture && <img class="whole-picture" src={picture.url} alt="The picture of this fit" />}</div>
      <div class="panel">
        <div class="panel-scroll">
          <section class="section">
            <h1 class="title">{job.state === "queued" ? "Waiting for its turn" : "Fitting the body"}</h1>
            <progress class="bar" max={100} value={percent} aria-label="Progress of the fit">
              {percent} %
            </progress>
            <AssumptionNotes assumptions={assumed.value[job.id] ?? []} />
            <ol class="stages">
              {STAGES.map((stage, i) => (
                <li key={stage.name} class={i < at ? "is-done" : i === at ? "is-current" : ""} aria-current={i === at ? "step" : undefined}>
                  <b>{stage.label}</b>
                  <span>{stage.help}</span>
                </li>
              ))}
            </ol>
          </section>
          <section class="section">
            <h2>Energy</h2>
            <p class="fine">How badly the body explains the picture, in nats. Several starts are tried; the best is kept.</p>
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
            {stopping ? "Stopping …" : "Cancel"}
          </button>
        </div>
      </div>
    </main>
  );
}
