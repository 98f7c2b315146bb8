# Elements and the solver are those of core/radiosity.
target_link_libraries(technique_illumination_samples PRIVATE limn::reference)
