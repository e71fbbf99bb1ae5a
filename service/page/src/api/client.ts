// One way to ask the service: same origin, key if there is one, problems as errors.
import { UNREACHABLE, isReached, pause, pauseMs } from "./connection";
import { apiKey, askForKey } from "./key";
import type { Problem } from "./types";

type OwnProblem = "page-error" | "unexpected-answer" | "unreachable";

/** An answer that is no success, as the service explains it (RFC 9457). */
export class ProblemError extends Error {
  constructor(
    readonly problem: Problem,
    readonly retryAfterS: number | null = null,
  ) {
    super(problem.detail);
  }
}

export async function request(path: string, init: RequestInit = {}): Promise<Response> {
  for (;;) {
    const presented = apiKey.value;
    const response = await send(path, init, presented);
    if (response.ok) return response;
    const error = await problemOf(response, path);
    if (response.status !== 401) throw error;
    // Another question may have been answered in the meantime: then try the new key first.
    if (apiKey.value === presented) await askForKey(error.problem.detail);
  }
}

export async function requestJson<T>(path: string, init: RequestInit = {}): Promise<T> {
  return (await (await request(path, init)).json()) as T;
}

export function jsonBody(value: unknown): { method: string; headers: Record<string, string>; body: string } {
  return {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(value),
  };
}

/** Ask, and while the service is not reached, ask again after ever longer pauses. */
export async function untilReached<T>(ask: () => Promise<T>, leaving: AbortSignal): Promise<T> {
  for (let attempts = 0; ; attempts++) {
    try {
      return await ask();
    } catch (error) {
      if (leaving.aborted || !isUnreachable(error)) throw error;
      await pause(pauseMs(attempts), leaving);
    }
  }
}

export function isUnreachable(error: unknown): boolean {
  return error instanceof ProblemError && error.problem.code === UNREACHABLE;
}

/** What to tell of any error; null for those that are none (an abandoned request). */
export function problemFrom(error: unknown): Problem | null {
  if (error instanceof ProblemError) return error.problem;
  if (error instanceof DOMException && error.name === "AbortError") return null;
  return ownProblem("page-error", String(error));
}

/** A problem that no service told: its words are in the page's catalogue, `detail` is for whoever mends it. */
function ownProblem(code: OwnProblem, detail = ""): Problem {
  return { type: `/problems/${code}`, title: "", status: 500, detail, code, remedy: "", field: null, instance: null, errors: [] };
}

async function send(path: string, init: RequestInit, key: string | null): Promise<Response> {
  const headers = new Headers(init.headers);
  if (key !== null) headers.set("Authorization", `Bearer ${key}`);
  try {
    const response = await fetch(path, { ...init, headers });
    isReached.value = true;
    return response;
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    isReached.value = false;
    throw new ProblemError(ownProblem(UNREACHABLE));
  }
}

async function problemOf(response: Response, path: string): Promise<ProblemError> {
  const wait = Number(response.headers.get("Retry-After"));
  const retryAfterS = wait > 0 ? wait : null;
  if (response.headers.get("Content-Type")?.startsWith("application/problem+json")) {
    return new ProblemError((await response.json()) as Problem, retryAfterS);
  }
  const detail = `${path} was answered with ${response.status} ${response.statusText}.`;
  return new ProblemError(ownProblem("unexpected-answer", detail), retryAfterS);
}
