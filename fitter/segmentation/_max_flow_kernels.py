"""Compiled maximum flow on a band of pixels. Plain arrays in and out.

Nodes have eight arcs, one per neighbour: arc ``8 * node + direction`` leads to ``heads[arc]``, or
nowhere if that is -1. Directions number the neighbours in reading order, so that direction
``7 - d`` is opposite to ``d`` and the reverse of an arc is found without a table.
"""

from typing import no_type_check

import numpy as np
from numba import njit

FREE, SOURCE, SINK = 0, 1, 2
"""Which search tree a node is in."""

NO_ARC, TO_TERMINAL, ORPHAN = -1, -2, -3
"""Values in place of the arc to a node's parent: for nodes attached to their terminal, and for
those whose arc to the parent was just saturated."""

NOWHERE = 2**31 - 1


@no_type_check
@njit(cache=True, nogil=True)
def push_to_neighbours(heads, capacities, terminals):
    """Push what flow can go from an excess to a deficit over a single arc; in place.

    Most of the flow in GrabCut is of this kind, and this way it needs no search tree.
    """
    for node in range(terminals.shape[0]):
        if terminals[node] <= 0:
            continue
        for arc in range(8 * node, 8 * node + 8):
            if capacities[arc] == 0:
                continue
            other = heads[arc]
            if terminals[other] >= 0:
                continue
            amount = min(terminals[node], capacities[arc], -terminals[other])
            capacities[arc] -= amount
            capacities[8 * other + 7 - (arc & 7)] += amount
            terminals[other] += amount
            terminals[node] -= amount
            if terminals[node] == 0:
                break


@no_type_check
@njit(cache=True, nogil=True)
def maximum_flow(heads, capacities, terminals):
    """Boykov and Kolmogorov's maximum flow (PAMI 2004, section 3); updates the graph in place.

    Two trees of unsaturated arcs grow from the terminals until they touch; flow is pushed along the
    path, and nodes left behind saturated arcs find a new parent in their tree or become free.
    Time-stamped distances to the terminal keep the trees shallow (section 3.2.3).

    ``terminals`` (n,) is what each node can still receive from the source, negative where it can
    still give to the sink. At the end both arrays hold the residual capacities, so that after a
    change of the terminals the next cut can go on from there: add the change to the residuals.

    Returns the (n,) tree of each node. Those in SOURCE's tree are its side of the smallest minimum
    cut.
    """
    count = terminals.shape[0]
    tree = np.zeros(count, dtype=np.uint8)
    parents = np.full(count, NO_ARC, dtype=np.int32)
    distance = np.zeros(count, dtype=np.int32)
    known_at = np.zeros(count, dtype=np.int32)
    # A ring buffer: a node is in it at most once.
    queue = np.empty(count + 1, dtype=np.int32)
    queued = np.zeros(count, dtype=np.bool_)
    first = last = 0
    orphans = np.empty(count, dtype=np.int32)
    for node in range(count):
        if terminals[node] != 0:
            tree[node] = SOURCE if terminals[node] > 0 else SINK
            parents[node] = TO_TERMINAL
            distance[node] = 1
            queued[node] = True
            queue[last] = node
            last += 1
    time = 0
    while first != last:
        node = queue[first]
        own = tree[node]
        meeting = NO_ARC
        if own != FREE:
            for arc in range(8 * node, 8 * node + 8):
                other = heads[arc]
                if other < 0:
                    continue
                back = 8 * other + 7 - (arc & 7)
                if capacities[arc if own == SOURCE else back] == 0:
                    continue
                if tree[other] == FREE:
                    tree[other] = own
                    parents[other] = back
                    distance[other] = distance[node] + 1
                    known_at[other] = known_at[node]
                    if not queued[other]:
                        queued[other] = True
                        queue[last] = other
                        last = last + 1 if last < count else 0
                elif tree[other] != own:
                    meeting = arc if own == SOURCE else back
                    break
                elif known_at[other] <= known_at[node] and distance[other] > distance[node] + 1:
                    parents[other] = back
                    distance[other] = distance[node] + 1
                    known_at[other] = known_at[node]
        if meeting == NO_ARC:
            queued[node] = False
            first = first + 1 if first < count else 0
            continue
        time += 1
        orphan_count = _augment(heads, capacities, terminals, parents, meeting, orphans)
        # Adoption. The list is a queue, nearest first.
        next_orphan = 0
        while next_orphan < orphan_count:
            node = orphans[next_orphan % count]
            next_orphan += 1
            own = tree[node]
            best, best_distance = NO_ARC, NOWHERE
            for arc in range(8 * node, 8 * node + 8):
                other = heads[arc]
                if other < 0 or tree[other] != own:
                    continue
                back = 8 * other + 7 - (arc & 7)
                if capacities[back if own == SOURCE else arc] == 0:
                    continue
                length = _distance_to_terminal(heads, parents, distance, known_at, other, time)
                if length < best_distance:
                    best, best_distance = arc, length
            if best != NO_ARC:
                parents[node] = best
                distance[node] = best_distance + 1
                known_at[node] = time
                continue
            for arc in range(8 * node, 8 * node + 8):
                other = heads[arc]
                if other < 0 or tree[other] != own:
                    continue
                back = 8 * other + 7 - (arc & 7)
                if capacities[back if own == SOURCE else arc] > 0 and not queued[other]:
                    queued[other] = True
                    queue[last] = other
                    last = last + 1 if last < count else 0
                if parents[other] == back:
                    parents[other] = ORPHAN
                    orphans[orphan_count % count] = other
                    orphan_count += 1
            tree[node] = FREE
            parents[node] = NO_ARC
    return tree


@no_type_check
@njit(cache=True, nogil=True)
def _augment(heads, capacities, terminals, parents, meeting, orphans):
    """Saturate the path over the arc where the trees met; returns how many orphans that leaves."""
    start, end = heads[8 * heads[meeting] + 7 - (meeting & 7)], heads[meeting]
    amount = capacities[meeting]
    node = start
    while parents[node] != TO_TERMINAL:
        arc = parents[node]
        node = heads[arc]
        amount = min(amount, capacities[8 * node + 7 - (arc & 7)])
    amount = min(amount, terminals[node])
    node = end
    while parents[node] != TO_TERMINAL:
        arc = parents[node]
        node = heads[arc]
        amount = min(amount, capacities[arc])
    amount = min(amount, -terminals[node])
    capacities[meeting] -= amount
    capacities[8 * end + 7 - (meeting & 7)] += amount
    orphan_count = 0
    node = start
    while True:
        arc = parents[node]
        if arc == TO_TERMINAL:
            break
        parent = heads[arc]
        forward = 8 * parent + 7 - (arc & 7)
        capacities[forward] -= amount
        capacities[arc] += amount
        if capacities[forward] == 0:
            parents[node] = ORPHAN
            orphans[orphan_count] = node
            orphan_count += 1
        node = parent
    terminals[node] -= amount
    if terminals[node] == 0:
        parents[node] = ORPHAN
        orphans[orphan_count] = node
        orphan_count += 1
    node = end
    while True:
        arc = parents[node]
        if arc == TO_TERMINAL:
            break
        parent = heads[arc]
        capacities[arc] -= amount
        capacities[8 * parent + 7 - (arc & 7)] += amount
        if capacities[arc] == 0:
            parents[node] = ORPHAN
            orphans[orphan_count] = node
            orphan_count += 1
        node = parent
    terminals[node] += amount
    if terminals[node] == 0:
        parents[node] = ORPHAN
        orphans[orphan_count] = node
        orphan_count += 1
    return orphan_count


@no_type_check
@njit(cache=True, nogil=True)
def _distance_to_terminal(heads, parents, distance, known_at, start, time):
    """Number of arcs from a node to its terminal, NOWHERE if it descends from an orphan; cached."""
    length = 0
    node = start
    while known_at[node] != time:
        arc = parents[node]
        length += 1
        if arc == TO_TERMINAL:
            known_at[node] = time
            distance[node] = 1
            length -= 1
            break
        if arc == ORPHAN:
            return NOWHERE
        node = heads[arc]
    length += distance[node]
    end = node
    node = start
    left = length
    while node != end:
        known_at[node] = time
        distance[node] = left
        left -= 1
        node = heads[parents[node]]
    return length
