//! Contacts kept, lost and gained between two states (Table IV of the 2008 paper).

/// Numbers of maintained, destroyed and created contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BondChanges {
    /// N(=): in both states.
    pub kept: usize,
    /// N(−): only before.
    pub lost: usize,
    /// N(+): only after.
    pub gained: usize,
}

impl BondChanges {
    /// Compares two lists of pairs (i < j), each sorted and without repetition.
    #[must_use]
    pub fn between(before: &[(u32, u32)], after: &[(u32, u32)]) -> Self {
        let mut changes = Self::default();
        let mut rest = after.iter().peekable();
        for pair in before {
            while rest.next_if(|&next| next < pair).is_some() {
                changes.gained += 1;
            }
            if rest.next_if_eq(&pair).is_some() {
                changes.kept += 1;
            } else {
                changes.lost += 1;
            }
        }
        changes.gained += rest.count();
        changes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_every_pair_once() {
        let before = [(0, 1), (0, 2), (1, 2), (3, 4)];
        let after = [(0, 2), (0, 5), (1, 2), (2, 9), (7, 8)];
        assert_eq!(BondChanges::between(&before, &after), BondChanges { kept: 2, lost: 2, gained: 3 });
        assert_eq!(BondChanges::between(&before, &before), BondChanges { kept: 4, lost: 0, gained: 0 });
        assert_eq!(BondChanges::between(&[], &after).gained, 5);
        assert_eq!(BondChanges::between(&after, &[]).lost, 5);
    }
}
