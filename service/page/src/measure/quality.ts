// How far a scan is to be trusted, in a few sentences.
import type { Finding, ScanResult } from "../api/types";
import { percent } from "../messages/figures";
import { messages } from "../messages/language";
import { isContradicted } from "../result/outcome";

/** Told by the page itself, with the picture it belongs to. */
const DIFFERENT_PEOPLE = "different-people";

/** Below it the service warns, and a share is said to be small. */
const USUAL_AGREEMENT = 0.1;

export interface Quality {
  readonly text: string;
  readonly isBad: boolean;
  /** How well the pictures agree with each other; null where that says nothing. */
  readonly agreement: string | null;
}

type Judged = Pick<ScanResult, "verdict" | "agreement"> & {
  readonly warnings: readonly { readonly code: string }[];
  readonly views: readonly { readonly findings: readonly Pick<Finding, "severity">[] }[];
};

export function qualityOf(result: Judged): Quality {
  const { quality } = messages.value.measure;
  const findings = result.views.flatMap(({ findings }) => findings);
  const agreement = agreementText(result.agreement);
  if (isContradicted(result)) return { text: quality.contradicted, isBad: true, agreement: null };
  if (result.warnings.some(({ code }) => code === DIFFERENT_PEOPLE)) return { text: quality.differentPeople, isBad: true, agreement };
  if (findings.some(({ severity }) => severity === "blocks")) return { text: quality.poor, isBad: true, agreement };
  if (findings.length > 0) return { text: quality.fair, isBad: false, agreement };
  return { text: quality.good, isBad: false, agreement };
}

function agreementText(share: number): string {
  const { quality } = messages.value.measure;
  if (share < USUAL_AGREEMENT) return quality.rarely(shareText(share));
  return share >= 0.995 ? quality.nearlyAlways : quality.often(shareText(share));
}

/** Small shares with a digit: one in a thousand is not none. */
function shareText(share: number): string {
  if (share < 0.0005) return messages.value.derived.lessThan(percent(0.001, 1));
  return percent(share, share < 0.0095 ? 1 : 0);
}
