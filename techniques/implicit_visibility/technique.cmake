# Elements and links are those of core/radiosity.
target_link_libraries(technique_implicit_visibility PRIVATE limn::reference)
