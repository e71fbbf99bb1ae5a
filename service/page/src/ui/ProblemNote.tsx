// A problem as the service tells it: what, where, and what to do.
import type { Problem } from "../api/types";

export function ProblemNote({ problem }: { problem: Problem }) {
  const errors = problem.errors ?? [];
  return (
    <div class="note is-problem" role="alert">
      <strong>{problem.title}</strong>
      {errors.length > 0 ? (
        <ul>
          {errors.map((error) => (
            <li key={error.field + error.code}>
              {readable(error.field)}: {error.reason} {error.remedy}
            </li>
          ))}
        </ul>
      ) : (
        <p>
          {problem.detail} {problem.remedy}
        </p>
      )}
    </div>
  );
}

/** `points.left_hip` as a person says it. */
function readable(field: string): string {
  return field.replace(/^(points|measurements)\./, "").replaceAll("_", " ");
}
