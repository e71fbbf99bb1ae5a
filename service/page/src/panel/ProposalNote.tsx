// What the service says of the points it proposes, and the way from proposing to clicking and back.
// What changes is announced by whoever changes it: these notes are no status of their own.
import { canPropose, current, points } from "../draft/draft";
import { clickAll, isProposing, others, proposal, proposalWord, propose } from "../draft/proposing";
import { messages } from "../messages";
import { hasProposed, isAllProposed } from "../points/proposed";
import { ProblemNote } from "../ui/ProblemNote";
import { remarked } from "../ui/answered";

export function ProposalNote() {
  if (!canPropose.value) return null;
  const found = proposal.value;
  const problem = current.value!.proposalProblem.value;
  return (
    <>
      {isProposing.value && <p class="fine">{proposalWord.value}</p>}
      {problem && <ProblemNote problem={problem} />}
      {found?.person === null && proposalWord.value && <p class="note">{proposalWord.value}</p>}
      {others.value.length > 0 && <Persons count={others.value.length} chosen={points.value.person} />}
      <Ways />
    </>
  );
}

/** What should be known of proposed points. */
export function ProposalWarnings() {
  const found = proposal.value;
  if (!found || found.warnings.length === 0 || !hasProposed(points.value)) return null;
  return (
    <div class="note">
      {found.warnings.map((warning) => (
        <p key={warning.code}>{remarked(warning)}</p>
      ))}
    </div>
  );
}

export function ClickAll({ kind }: { kind: "button is-small" | "link" }) {
  return (
    <button class={kind} type="button" onClick={clickAll}>
      {messages.panel.proposal.clickAll}
    </button>
  );
}

function Persons({ count, chosen }: { count: number; chosen: number | null }) {
  return (
    <div class="note">
      <p>{messages.stage.several(count)}</p>
      <div class="row">
        {Array.from({ length: count }, (_, i) => (
          <button key={i} class="button is-small" type="button" aria-pressed={i === chosen} onClick={() => propose(i)}>
            {messages.panel.proposal.person(i + 1)}
          </button>
        ))}
      </div>
    </div>
  );
}

function Ways() {
  const nobody = proposal.value?.person === null;
  const offersProposal = !isProposing.value && !nobody && !isAllProposed(points.value);
  const offersClicks = isProposing.value || Object.keys(points.value.placed).length > 0;
  return (
    <div class="row">
      {offersClicks && <ClickAll kind="button is-small" />}
      {offersProposal && (
        <button class="button is-small" type="button" onClick={() => propose()}>
          {messages.panel.proposal.propose}
        </button>
      )}
    </div>
  );
}
