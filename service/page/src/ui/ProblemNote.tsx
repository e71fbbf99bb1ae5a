// A problem: what, where, and what to do; in the page's words where it knows the code.
import type { Problem } from "../api/types";
import { messages } from "../messages";
import { answered, fieldName } from "./answered";

export function ProblemNote({ problem }: { problem: Problem }) {
  const errors = problem.errors ?? [];
  const { frame } = messages;
  // What no service told has its words in the catalogue; its detail is what the browser said.
  const isOwn = problem.title === "";
  const title = answered("titles", problem.type.split("/").at(-1)!);
  return (
    <div class="note is-problem" role="alert">
      <strong>{title ?? problem.title}</strong>
      {errors.length > 0 ? (
        <ul>
          {errors.map((error) => (
            <li key={error.field + error.code}>
              {frame.ofField(fieldName(error.field), "")}
              {answered("faults", error.code) ?? `${error.reason} ${error.remedy}`}
            </li>
          ))}
        </ul>
      ) : (
        <p>
          {answered("faults", problem.code) ?? `${problem.detail} ${problem.remedy}`}
          {isOwn && problem.detail && (
            <>
              {" "}
              {problem.detail}
            </>
          )}
        </p>
      )}
    </div>
  );
}
