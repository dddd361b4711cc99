#!/bin/sh
# SPDX-License-Identifier: MIT
# Usage: filter.sh FILE
# Doxygen's input filter. Guides: removes the anchors from links, since Doxygen 1.9.4 does not know the anchors that GitHub
# gives to headings; of a link within a page, only the text remains. Headers: documents overrides and OSG's copy
# constructors, whose meaning OSG defines.
case "$1" in
*.md) sed -E 's/\[([^]]*)\]\(#[^)]*\)/\1/g
              s/\]\(([^)#]*)#[^)]*\)/](\1)/g' "$1" ;;
*) sed -E 's/( override( \{.*\}|;))$/\1 \/**< Overrides a function of the base class. *\//
           s/(const osg::CopyOp& copyop( = [^)]*)?\);)$/\1 \/**< Copies as `osg::clone` requires. *\//' "$1" ;;
esac
