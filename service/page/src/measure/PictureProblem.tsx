// Why a picture cannot be measured. Which one it is says the place where this stands.
import type { Problem } from "../api/types";
import { messages } from "../messages";
import { ProblemNote } from "../ui/ProblemNote";
import { plainly } from "./plainly";

export function PictureProblem({ problem }: { problem: Problem }) {
  const errors = problem.errors ?? [];
  if (errors.length === 0) return <ProblemNote problem={problem} />;
  return (
    <div class="note is-problem" role="alert">
      <strong>{messages.measure.unusable}</strong>
      {errors.map(({ field, code, reason, remedy }) => (
        <p key={field + code}>{plainly("faults", code) ?? `${reason} ${remedy}`}</p>
      ))}
    </div>
  );
}
