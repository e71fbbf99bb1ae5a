// In place of measurements that are withheld: why, and a way to have them all the same.
import { useSignal } from "@preact/signals";
import { problemFrom } from "../api/client";
import type { Job, Problem } from "../api/types";
import type { Picture } from "../draft/picture";
import { ProblemNote } from "../ui/ProblemNote";
import { measureAnyway } from "./anyway";

export function Withheld({ job, picture }: { job: Job; picture: Picture | null }) {
  const problem = useSignal<Problem | null>(null);
  const sending = useSignal(false);
  const send = async () => {
    sending.value = true;
    problem.value = null;
    try {
      await measureAnyway(picture!, job);
    } catch (error) {
      problem.value = problemFrom(error);
    } finally {
      sending.value = false;
    }
  };
  return (
    <section class="section" aria-labelledby="measures-title">
      <h2 id="measures-title">Measurements</h2>
      <p>They are withheld: they would be those of a body that nobody in the picture has.</p>
      {problem.value && <ProblemNote problem={problem.value} />}
      <button class="button" type="button" disabled={!picture || sending.value} onClick={send}>
        {sending.value ? "Sending …" : "Measure anyway"}
      </button>
    </section>
  );
}
