import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import maximum_flow as reference_flow

from fitter.segmentation._max_flow_kernels import SOURCE, maximum_flow, push_to_neighbours

OFFSETS = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))


def random_band(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(n, 8) heads and capacities and (n,) terminals of a small grid with holes."""
    random = np.random.default_rng(seed)
    height, width = random.integers(2, 14, 2)
    present = random.random((height, width)) < random.choice([0.5, 0.8, 1.0])
    present[0, 0] = True
    nodes = np.full((height + 2, width + 2), -1, dtype=np.int32)
    nodes[1:-1, 1:-1][present] = np.arange(present.sum())
    rows, columns = np.nonzero(nodes >= 0)
    heads = np.stack([nodes[rows + i, columns + j] for i, j in OFFSETS], axis=1)
    capacities = np.where(heads >= 0, random.integers(0, 30, heads.shape), 0).astype(np.int32)
    return heads, capacities, random.integers(-40, 40, len(rows)).astype(np.int32)


def reference_value(heads: np.ndarray, capacities: np.ndarray, terminals: np.ndarray) -> int:
    count = len(terminals)
    node, direction = np.nonzero(heads >= 0)
    every = np.arange(count)
    source, sink = np.full(count, count), np.full(count, count + 1)
    weights = [capacities[node, direction], np.maximum(terminals, 0), np.maximum(-terminals, 0)]
    starts = np.concatenate([node, source, every])
    ends = np.concatenate([heads[node, direction], every, sink])
    graph = coo_matrix((np.concatenate(weights), (starts, ends)), shape=(count + 2, count + 2))
    return reference_flow(graph.tocsr().astype(np.int32), count, count + 1).flow_value


def cut_value(
    heads: np.ndarray, capacities: np.ndarray, terminals: np.ndarray, above: np.ndarray
) -> int:
    node, direction = np.nonzero(heads >= 0)
    severed = above[node] & ~above[heads[node, direction]]
    return int(
        capacities[node, direction][severed].sum()
        + np.maximum(terminals, 0)[~above].sum()
        + np.maximum(-terminals, 0)[above].sum()
    )


@pytest.mark.parametrize("seed", range(60))
def test_the_cut_is_worth_the_maximum_flow(seed: int):
    heads, capacities, terminals = random_band(seed)
    left, receiving = capacities.ravel().copy(), terminals.copy()
    above = maximum_flow(heads.ravel(), left, receiving) == SOURCE
    expected = reference_value(heads, capacities, terminals)
    assert cut_value(heads, capacities, terminals, above) == expected
    assert np.maximum(terminals, 0).sum() - np.maximum(receiving, 0).sum() == expected
    assert (left >= 0).all()


@pytest.mark.parametrize("seed", range(60))
def test_a_changed_cut_goes_on_from_the_flow_before(seed: int):
    heads, capacities, terminals = random_band(seed)
    random = np.random.default_rng([seed, 1])
    left, receiving = capacities.ravel().copy(), terminals.copy()
    for _ in range(4):
        push_to_neighbours(heads.ravel(), left, receiving)
        above = maximum_flow(heads.ravel(), left, receiving) == SOURCE
        expected = reference_value(heads, capacities, terminals)
        assert cut_value(heads, capacities, terminals, above) == expected
        change = random.integers(-25, 25, len(terminals)).astype(np.int32)
        terminals, receiving = terminals + change, receiving + change


def test_a_chain_is_cut_at_its_weakest_arc():
    heads = np.full((4, 8), -1, dtype=np.int32)
    capacities = np.zeros((4, 8), dtype=np.int32)
    for node, capacity in enumerate((7, 3, 5)):
        heads[node, 4], heads[node + 1, 3] = node + 1, node
        capacities[node, 4] = capacities[node + 1, 3] = capacity
    terminals = np.array([10, 0, 0, -10], dtype=np.int32)
    tree = maximum_flow(heads.ravel(), capacities.ravel(), terminals)
    np.testing.assert_array_equal(tree == SOURCE, [True, True, False, False])
    np.testing.assert_array_equal(terminals, [7, 0, 0, -7])
