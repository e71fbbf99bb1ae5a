// What came out: to look at on the left, to read on the right.
import { useState } from "preact/hooks";
import type { Job } from "../api/types";
import { DerivedPanel } from "../derived/DerivedPanel";
import type { Picture } from "../draft/picture";
import { openAgain } from "../panel/open";
import { ProblemNote } from "../ui/ProblemNote";
import { Actions } from "./Actions";
import { Downloads } from "./Downloads";
import { Facts } from "./Facts";
import { useResultFiles } from "./files";
import { Look } from "./Look";
import { Measures } from "./Measures";
import { Withheld } from "./Withheld";
import { measureAnyway } from "./anyway";
import { headingOf } from "./outcome";
import { withoutShading } from "./reading";
import type { Placement } from "../viewer/BodyScene";

export function ResultView({ job, picture }: { job: Job; picture: Picture | null }) {
  const { files, problem } = useResultFiles(job);
  const [pointedAt, pointAt] = useState<string | null>(null);
  const [shown, show] = useState<string | null>(null);
  const [placement, setPlacement] = useState<Placement>("picture");
  if (problem) {
    return (
      <main class="ended">
        <h1>The result cannot be shown</h1>
        <ProblemNote problem={problem} />
      </main>
    );
  }
  return (
    <main class="bench" aria-busy={files === null} data-fit={job.id}>
      <div class="bench-stage">{files && picture && (
          <Look
            job={job}
            files={files}
            picture={picture}
            placement={placement}
            onPlace={setPlacement}
            measure={pointedAt ?? shown}
          />
        )}</div>
      <div class="panel">
        <div class="panel-scroll">
          <section class="section">
            <h1 class="title">{files ? headingOf(files.result) : "The body"}</h1>
            {files && (
              <Facts
                result={files.result}
                onChange={picture && (() => void openAgain(picture, job))}
              />
            )}
          </section>
          {files && files.result.measurements.length === 0 && <Withheld onAnyway={picture && (() => measureAnyway(picture, job))} />}
          {files && files.result.measurements.length > 0 && (
            <Measures
              measurements={files.result.measurements}
              before={withoutShading(files.result)}
              pointedAt={pointedAt ?? shown}
              onPoint={pointAt}
              onShow={(name) => {
                show(shown === name ? null : name);
                setPlacement("canonical");
              }}
            />
          )}
          {files && <DerivedPanel fit={job} hasLight={files.result.light !== null} />}
          {files && <Downloads job={job} result={files.result} />}
        </div>
        <Actions job={job} picture={picture} />
      </div>
    </main>
  );
}
